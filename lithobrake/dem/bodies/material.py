"""Materials: what a person says of the solid that bodies and planes are made of."""

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Material:
    """An isotropic elastic, frictional solid.

    young_modulus [Pa] > 0, poisson_ratio [-] in [0, 0.5), restitution [-] in (0, 1], friction [-] >= 0, density
    [kg/m3] > 0. A rigid body is any large finite Young's modulus.

    rolling_friction, spinning_friction [-] >= 0: a contact resists rolling, and spinning about its normal, up to this
    times contact radius R* times normal force. Source: [Ai-2011], model C.

    cohesion_force [N] >= 0 and surface_energy [J/m2] >= 0: contacts pull with cohesion_force + 4 pi surface_energy R*
    while they last, not beyond. Source: [Derjaguin-1975]. Lunar soil has, by [Perko-2001], a pull
    of 0.036 S^2 R* newtons, S the cleanliness from 0 to 1: a surface energy of 0.0029 S^2 J/m2.

    rough: contacts have its friction, whatever the other material and the rule for pairs; of two, the larger.

    Raises ValueError outside these ranges.
    """

    young_modulus: float
    poisson_ratio: float
    restitution: float
    friction: float
    density: float
    rolling_friction: float = 0.0
    spinning_friction: float = 0.0
    cohesion_force: float = 0.0
    surface_energy: float = 0.0
    rough: bool = False

    def __post_init__(self) -> None:
        allowed = {
            "young_modulus": (0.0 < self.young_modulus < math.inf, "a finite value above 0 Pa"),
            "poisson_ratio": (0.0 <= self.poisson_ratio < 0.5, "0 <= value < 0.5"),
            "restitution": (0.0 < self.restitution <= 1.0, "0 < value <= 1"),
            "friction": (0.0 <= self.friction < math.inf, "a finite value of at least 0"),
            "density": (0.0 < self.density < math.inf, "a finite value above 0 kg/m3"),
            "rolling_friction": (0.0 <= self.rolling_friction < math.inf, "a finite value of at least 0"),
            "spinning_friction": (0.0 <= self.spinning_friction < math.inf, "a finite value of at least 0"),
            "cohesion_force": (0.0 <= self.cohesion_force < math.inf, "a finite value of at least 0 N"),
            "surface_energy": (0.0 <= self.surface_energy < math.inf, "a finite value of at least 0 J/m2"),
        }
        for name, (fine, text) in allowed.items():
            if not fine:
                raise ValueError(f"Material.{name} is {getattr(self, name)!r}; allowed is {text}: change it")
