"""What the SPICE kernels of [site] stand for: how the body turns, and where its partner is."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from lithobrake.files.file_kinds import FileKind, file_kind
from lithobrake.study.impact_sections import SiteSection
from lithobrake.vocabulary.clock import Epoch
from lithobrake.vocabulary.known_bodies import BUILT_IN_BODIES

if TYPE_CHECKING:
    from lithobrake.smallbody import PartnerPlace, SpinState


def kernel_spin(site: SiteSection) -> "SpinState | None":
    """How the body turns; None without kernels. Raises ValueError or ImportError as read_spin does."""
    if not site.kernels:
        return None
    from lithobrake.smallbody import read_spin

    return read_spin(site.kernels, _name(site))


def kernel_partner(site: SiteSection) -> "PartnerPlace | None":
    """Where the partner stands at the epoch; None without one. Raises ValueError or ImportError as read_partner does"""
    if not site.kernels or site.epoch is None:
        return None
    from lithobrake.smallbody import read_partner

    partner = BUILT_IN_BODIES[site.body].partner
    assert partner is not None
    return read_partner(site.kernels, _name(site), partner, site.epoch)


def kernel_values(site: SiteSection) -> dict[str, float]:
    """The numbers of the section that kernels stand for, by key."""
    spin, place = kernel_spin(site), kernel_partner(site)
    values = {} if spin is None else {"spin_period": spin.period}
    return values if place is None else values | {"partner_longitude_deg": place.longitude_deg}


def kernel_problems(site: SiteSection) -> Iterator[str]:
    """One sentence for each thing wrong; where nothing is, the kernels have been read."""
    # Reading starts a process of its own, as NAIF's library may abort it, and takes half a second: keys are checked
    # first.
    found = list(_key_problems(site))
    yield from found
    if site.kernels and not found:
        try:
            kernel_values(site)
        except (ValueError, ImportError) as error:
            yield f"site.kernels: {error}"


def _key_problems(site: SiteSection) -> Iterator[str]:
    for key in ("kernel_body", "epoch"):
        if getattr(site, key) is not None and not site.kernels:
            yield f"site.{key} goes with site.kernels, of which there are none; name kernels, or leave it out"
    if not site.kernels:
        return
    for path in site.kernels:
        if not os.path.isfile(path):
            yield f'site.kernels has "{path}"; no such file; give its path from the study file'
        elif (kind := file_kind(Path(path))) not in (None, FileKind.TEXT_KERNEL, FileKind.BINARY_KERNEL):
            remedy = "give it as site.body" if kind is FileKind.SHAPE_KERNEL else "leave it out"
            yield f'site.kernels has "{path}", which is {kind}; allowed: PCK, LSK, SPK and meta-kernels; {remedy}'
    try:
        if site.epoch is not None:
            Epoch.of(site.epoch)
    except ValueError as error:
        yield f"site.epoch {error}"
    built_in = site.body in BUILT_IN_BODIES
    if not built_in and site.kernel_body is None:
        yield 'site.kernel_body is missing; kernels know a mesh by the name of its body, say "bennu", or its number'
    if site.epoch is not None and not (built_in and site.partner):
        yield "site.epoch says when to read where the partner stands, and the body has none; leave it out"
    for key, other in (("spin_period", "kernels"), ("partner_longitude_deg", "epoch")):
        if getattr(site, key) is not None and getattr(site, other):
            yield f"site.{key} is given, and site.{other} has it read from the kernels; leave one of the two out"


def _name(site: SiteSection) -> str:
    return site.kernel_body or site.body
