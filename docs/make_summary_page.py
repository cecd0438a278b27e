"""Write docs/summary.md, which says what every key of the summary, the scores and the expansions means."""

from pathlib import Path

from lithobrake.results.key_words import page

if __name__ == "__main__":
    Path(__file__).with_name("summary.md").write_text(page(), encoding="utf-8")
