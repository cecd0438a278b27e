"""What is installed, what this machine offers, and how fast it is: what to look at first where something does not work.

Nothing heavy is imported before it is known to be there, since a library that is missing is what is looked for.
"""

from lithobrake.doctor.diagnosis import Diagnosis, examine

__all__ = ["Diagnosis", "examine"]
