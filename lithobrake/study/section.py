"""What every table of the study file has in common."""

from pydantic import BaseModel, ConfigDict


class Section(BaseModel):
    """One table of the study file; a key that it does not know is refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)
