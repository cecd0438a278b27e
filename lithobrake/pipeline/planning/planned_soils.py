"""The regions of a study with a soil of their own: how much ground each has, and which of them the aim point is in."""

from collections.abc import Mapping
from dataclasses import dataclass

from lithobrake.pipeline.design.soils import Soils
from lithobrake.pipeline.site import Site
from lithobrake.vocabulary.percentages import percent
from lithobrake.vocabulary.quantities import ELSEWHERE


@dataclass(frozen=True)
class PlannedSoils:
    """area_shares: of the surface, by region in the order of the file and ELSEWHERE. aim: region of the aim point."""

    area_shares: Mapping[str, float]
    aim: str

    def line(self) -> str:
        """All of it in a line of text."""
        shares = [f"{name} {percent(share, 1)}" for name, share in self.area_shares.items()]
        where = "outside of these regions, on [grain]" if self.aim == ELSEWHERE else f"in {self.aim}"
        return f"Soils: {', '.join(shares)} of the surface; the aim point is {where}."


def planned_soils(site: Site) -> PlannedSoils | None:
    """The soils of a study; None where it has one."""
    if not site.study.soil:
        return None
    soils, place = Soils(site), (site.medians["latitude_deg"], site.medians["longitude_deg"])
    (aim,) = soils.at(site.body.shape.surface_point(*place)[None])
    return PlannedSoils(soils.area_shares(), aim)
