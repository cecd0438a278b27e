"""Write docs/validation/deliveries.md from hera_spk.json and oem_samples.csv.

python validation/deliveries/write_page.py
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[2] / "benchmarks"))
from harness import Row, read_document, read_rows
from page import made, table, write_page, yes
from quantities import CODE, NOT_SHOWN, Quantity, counts, keep_quantities

HERE = Path(__file__).parent
# Each file was looked at; the page says what was found.
CAUSES = {
    ("valid", "XML"): "each is refused by name: text alone is read",
    ("valid", "compressed"): "each is refused by name: text alone is read",
    ("invalid", "text"): "the fault is where no state is",
}
WORDS = {"at_rest": "at rest", "under_way": "still under way", "escaped": "escaped", "partner": "on Dimorphos"}


def difference(words: str, value: str, tolerance: str, agrees: bool) -> Quantity:
    return Quantity(CODE, words, "0", value, value, tolerance, agrees, "hera_spk")


def hera_lines(kept: Row) -> list[Quantity]:
    """Differences from the kernels."""
    starts = kept["starts"]
    lines = [difference("body-fixed position at the start, largest difference from SPICE [m]",
                        f"{starts['position_m']:.1e}", "0.001", starts["position_m"] <= 1e-3),
             difference("body-fixed velocity at the start, largest difference [m/s]",
                        f"{starts['velocity_m_s']:.1e}", "1e-06", starts["velocity_m_s"] <= 1e-6)]  # fmt: skip
    for one in kept["coasts"]:
        words = (
            f"coast of {one['duration_s'] / 3600.0:.1f} h over {one['way_m']:.0f} m: difference from the trajectory [m]"
        )
        tolerance = f"{0.01 * one['way_m']:.1f} (1 % of the way)"
        lines.append(difference(words, f"{one['off_m']:.1f}", tolerance, one["agrees"]))
    return lines


def message_lines(rows: list[Row]) -> list[tuple[Quantity, tuple[str, ...]]]:
    """Whether all files of a verdict and a form are read, or refused, as the verdict has it, and cells of the page."""
    lines = []
    for verdict in ("real", "valid", "invalid"):
        for form in ("text", "XML", "compressed"):
            own = [row for row in rows if (row["verdict"], row["form"]) == (verdict, form)]
            read = sum(row["states"] > 0 for row in own)
            if own:
                asked = 0 if verdict == "invalid" else len(own)
                one = Quantity(CODE, f"{len(own)} messages, {verdict}, {form}: read", str(asked), str(read), "", "all",
                               read == asked, "oem_samples", CAUSES.get((verdict, form), NOT_SHOWN))  # fmt: skip
                lines.append((one, (verdict, form, str(len(own)), str(read), str(len(own) - read), yes(one.agrees))))
    return lines


def outcome(kept: Row) -> str:
    speed, angle, time = (kept["delivery"][key] for key in ("speed", "incidence_deg", "descent_s"))
    ends = ", ".join(f"{count} {WORDS.get(end, end)}" for end, count in kept["ends"].items())
    return (
        f"All states lie {1e-3 * kept['distance_m'][0]:.2f} km from the centre of Didymos. "
        f"{kept['flights'].get('impact', 0)} of {kept['landers']} landers reach the ground of Didymos, after "
        f"{time[1] / 3600.0:.1f} h in the median (5 to 95 %: {time[0] / 3600.0:.1f} to {time[2] / 3600.0:.1f} h), at "
        f"{speed[1]:.2f} m/s ({speed[0]:.2f} to {speed[2]:.2f}) and {angle[1]:.0f} degrees from the vertical "
        f"({angle[0]:.0f} to {angle[2]:.0f}). On hard ground of restitution 0.5, after one day: {ends}."
    )


def main() -> None:
    kept, messages = read_document(HERE / "hera_spk.json"), read_document(HERE / "oem_samples.json")
    rows = read_rows(HERE / "oem_samples.csv", {"states": float}, str)
    hera, told = hera_lines(kept), message_lines(rows)
    lenient = sum(row["states"] > 0 for row in rows if row["verdict"] == "invalid")
    count, agreeing, *_ = counts([*hera, *(one for one, _ in told)])
    cells = ((one.quantity, one.tolerance, one.here, yes(one.agrees)) for one in hera)
    write_page(
        "deliveries", agreeing=agreeing, count=count,
        landers=kept["landers"], hera=table(("quantity", "tolerance", "difference", "agrees"), cells),
        outcome=outcome(kept), files=len(rows), lenient=lenient,
        messages=table(("verdict", "form", "files", "read", "refused", "agrees"), (line for _, line in told)),
        hera_made=made(kept), messages_made=made(messages),
    )  # fmt: skip
    keep_quantities("deliveries", {
        "planning trajectory of Hera": hera, "sample messages of another reader": [one for one, _ in told],
    })  # fmt: skip


if __name__ == "__main__":
    main()
