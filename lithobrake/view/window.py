"""A motion in a window: turned with the mouse, moved on with a slider."""

from typing import TYPE_CHECKING

from lithobrake.view.scene import Scene

if TYPE_CHECKING:
    from lithobrake.results.moving_bodies import MovingBodies

SIZE = (1280, 800)


def show(bodies: "MovingBodies") -> None:
    """Open a window on the motion, and return when it is closed. Raises ImportError without PyVista."""
    scene = Scene(bodies, size=SIZE, off_screen=False)
    last = len(bodies.time) - 1
    if last > 0:
        scene.plotter.add_slider_widget(
            lambda value: scene.go_to(round(value)), [0, last], value=0, title="frame", fmt="%.0f", style="modern"
        )
    scene.plotter.show(title="lithobrake")
