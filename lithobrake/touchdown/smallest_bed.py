"""The smallest bed whose walls, or images, and floor do not answer while the lander is being struck."""

import math

from lithobrake.dem import Material, contact_duration, equivalent_radius
from lithobrake.touchdown.lander import Lander


def wave_speed(rock: Material, diameter: float, speed: float) -> float:
    """Return the speed [m/s] of the compression wave that an impact at `speed` [m/s] drives through grains.

    Loose grains carry no sound of their own: the stronger the blow, the faster the wave, (16/25)^(1/5) c^(4/5) v^(1/5)
    with c^2 = K d^(5/2) / m for Hertz contacts K overlap^(3/2) of grains of diameter d [m] and mass m.
    Source: [Nesterenko-1983], the solitary wave of an unloaded chain.
    """
    stiffness = 4.0 / 3.0 * 0.5 * rock.young_modulus / (1.0 - rock.poisson_ratio**2) * math.sqrt(0.25 * diameter)
    mass = rock.density * math.pi / 6.0 * diameter**3
    sound = math.sqrt(stiffness * diameter**2.5 / mass)
    return float((16.0 / 25.0) ** 0.2 * sound**0.8 * speed**0.2)


def smallest_bed(lander: Lander, rock: Material, diameter: float, speed: float) -> tuple[float, float]:
    """Return the smallest width and depth [m] of a bed of grains of a diameter [m] for an impact at a speed [m/s].

    The wave goes out with the first blow and must not be back before that blow, the Hertz collision of lander and
    grain, is over: the way to the floor and to a wall is at least half of wave speed times contact time, and the walls
    stand clear of the lander by that much on both sides. Ground that repeats sends the wave of each image of the lander
    instead of an echo, over the same way. Later blows meet a bed that is moving anyway.
    """
    grain = rock.density * math.pi / 6.0 * diameter**3
    mass = lander.mass * grain / (lander.mass + grain)
    radius = 1.0 / (1.0 / equivalent_radius(lander.shape) + 2.0 / diameter)
    modulus = 0.5 * rock.young_modulus / (1.0 - rock.poisson_ratio**2)
    way = wave_speed(rock, diameter, speed) * contact_duration(mass, radius, modulus, speed)
    return 2.0 * lander.reach + way, 0.5 * way
