"""A motion in a window: turned with the mouse, moved on with a slider."""

from typing import TYPE_CHECKING

from lithobrake.view.drawn_motion import DrawnMotion

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

SIZE = (1280, 800)


def show(bodies: "MovingBodies") -> None:
    """Open a window on the motion, and return when it is closed. Raises ImportError without PyVista."""
    drawn = DrawnMotion(bodies, size=SIZE, off_screen=False)
    last = len(bodies.time) - 1
    if last > 0:
        drawn.plotter.add_slider_widget(
            lambda value: drawn.go_to(round(value)), [0, last], value=0, title="frame", fmt="%.0f", style="modern"
        )
    drawn.plotter.show(title="lithobrake")
