"""Draw a slide of a study that follows landers to rest: its title, main results and map.

python examples/slide.py runs/hera

Writes runs/hera_slide.png, 1920 x 1080 pixels, next to the study's folder. To change its words, edit this file.
"""

import re
import sys
from pathlib import Path
from textwrap import fill

import matplotlib.pyplot as plt

from lithobrake import open_study

# Of the letters, the largest that fit into the height of the text [inch].
SIZES, TEXT_HEIGHT = (17, 15, 13, 11), 6.6


def main(folder: Path) -> Path:
    """Draw the slide."""
    study = open_study(folder)
    picture = next(folder.rglob("figure_*_ends.png"))
    figure = plt.figure(figsize=(16.0, 9.0), dpi=120)
    figure.text(0.04, 0.90, study.study["title"], fontsize=30, weight="bold")
    # No line ends between a number and its unit.
    # The answer, then the probability of what the study asks of whole journeys, then when and where they rest.
    asked = [one.statement for one in study.results.limit_states.values() if one.of_journey]
    others = [one for one in study.results.answer[1:] if one not in asked]
    told = [study.results.answer[0], *(f"{one.partition('. ')[0].rstrip('.')}." for one in asked), *others]
    sentences = [re.sub(r"(?<=\d) (?=[%a-z\d])", "\u00a0", one) for one in told[: max(3, 2 + len(asked))]]
    for size in SIZES:
        words = "\n\n".join(fill(one, 42 * SIZES[0] // size) for one in sentences)
        if 1.4 * size / 72.0 * words.count("\n") < TEXT_HEIGHT:
            break
    figure.text(0.04, 0.84, words, fontsize=size, va="top", linespacing=1.4)
    assumed = "Holds over the input ranges of the study file, and for ground that was not simulated."
    figure.text(0.04, 0.05, f"{assumed} Made with lithobrake.", fontsize=12, color="0.4")
    axes = figure.add_axes((0.42, 0.08, 0.56, 0.80))
    axes.imshow(plt.imread(picture), interpolation="lanczos")
    axes.axis("off")
    path = folder.with_name(f"{folder.resolve().name}_slide.png")
    figure.savefig(path)
    plt.close(figure)
    return path


if __name__ == "__main__":
    print(main(Path(sys.argv[1])))
