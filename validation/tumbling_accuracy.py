"""How exact torque-free rotation is after 12 h at 5 rad/s: against the same theory in 40 digits, in other forms.

    python validation/tumbling_accuracy.py [--spins 40]

The spin in the axes of the body is Jacobi's; the precession about the angular momentum is a Legendre integral of the
third kind here, where the package has Carlson's. Needs mpmath. Spins have even directions; their distance from the
separatrix is the least 1 - k^2 among them. Writes tumbling_accuracy.json beside this file.
"""

import sys
from pathlib import Path

import numpy as np
from mpmath import mp

from lithobrake.geometry.attitude import rotation_matrices
from lithobrake.smallbody import tumble

sys.path.insert(0, str(Path(__file__).parents[1] / "benchmarks"))
from harness import Row, command_line, origin, write_document

RESULTS = Path(__file__).with_suffix(".json")
# Principal moments, ascending [kg m2].
BODIES = ((0.2, 0.7, 0.8), (0.3, 0.35, 0.6), (0.5, 0.500001, 1.0), (0.5, 0.999999, 1.0), (0.98, 0.99, 1.0))
RATE, DURATION = 5.0, 43_200.0


def about(axis: int, angle: object) -> object:
    """The matrix of a turn about an axis, 0 or 2."""
    turn, (first, second) = mp.eye(3), ((1, 2) if axis == 0 else (0, 1))
    turn[first, first] = turn[second, second] = mp.cos(angle)
    turn[first, second], turn[second, first] = -mp.sin(angle), mp.sin(angle)
    return turn


def circled_frame(moments: list, momentum: list) -> tuple[list[int], object]:
    """Order of the axes with the circled one last, and the turn into these axes, the momentum forward along it."""
    low, high = moments[1] - moments[0], moments[2] - moments[1]
    upper = momentum[2] ** 2 * high / moments[2] > momentum[0] ** 2 * low / moments[0]
    order = [0, 1, 2] if upper else [2, 1, 0]
    frame = mp.eye(3) if upper else mp.matrix([[0, 0, 1], [0, -1, 0], [1, 0, 0]])
    return order, frame if momentum[order[2]] > 0 else mp.diag([1, -1, -1]) * frame


def exact(moments: tuple[float, ...], spin: np.ndarray) -> tuple[object, object]:
    """The turn of a body from no turn, and the complement 1 - k^2 of its motion."""
    inertia = [mp.mpf(one) for one in moments]
    momentum = [one * mp.mpf(float(rate)) for one, rate in zip(inertia, spin, strict=True)]
    size = mp.sqrt(sum(one**2 for one in momentum))
    order, frame = circled_frame(inertia, momentum)
    x, y, z = frame * mp.matrix(momentum) / size
    a, b, c = (inertia[one] for one in order)
    along, across = abs(z**2 * (c - a) / c + y**2 * (b - a) / b), abs(x**2 * (c - a) / a + y**2 * (c - b) / b)
    m = across * abs(b - a) / (along * abs(c - b))
    rate = (1 if c > a else -1) * size * mp.sqrt(along * abs(c - b) / (a * b * c))
    first, second = mp.sqrt(across * a / abs(c - a)), mp.sqrt(across * b / abs(c - b))
    third, n = mp.sqrt(along * c / abs(c - a)), 1 - (second / first) ** 2

    def integrals(phase: object) -> tuple[object, object]:
        turns = mp.nint(phase / mp.pi)
        rest = phase - turns * mp.pi
        return 2 * turns * mp.ellipk(m) + mp.ellipf(rest, m), 2 * turns * mp.ellippi(n, m) + mp.ellippi(n, rest, m)

    def to_momentum(phase: object) -> object:
        level = first * mp.cos(phase), second * mp.sin(phase)
        upward = third * mp.sqrt(1 - m * mp.sin(phase) ** 2)
        return about(0, mp.atan2(mp.hypot(*level), upward)) * about(2, mp.atan2(*level))

    phase = mp.atan2(y / second, x / first)
    begin, end = integrals(phase)[0], integrals(phase)[0] + rate * mp.mpf(DURATION)
    turns = mp.nint(end / (2 * mp.ellipk(m)))
    place = end - 2 * turns * mp.ellipk(m)
    after = mp.atan2(*(mp.ellipfun(name, place, m=m) for name in ("sn", "cn"))) + turns * mp.pi
    lean = (second**2 / b - first**2 / a) / -n
    third_kind = integrals(after)[1] - integrals(phase)[1]
    precession = size / rate * (lean / first**2 * (end - begin) + (1 / a - lean / first**2) * third_kind)
    return frame.T * to_momentum(phase).T * about(2, precession) * to_momentum(after) * frame, 1 - m


def accuracy(moments: tuple[float, ...], spin_count: int) -> Row:
    """Errors of one body: the largest difference of an element of the matrices of each spin."""
    random, errors, complements = np.random.default_rng(3), [], []
    for _ in range(spin_count):
        spin = random.normal(size=3)
        spin *= RATE / np.linalg.norm(spin)
        turn, complement = exact(moments, spin)
        found = rotation_matrices(tumble(np.diag(moments), [[1.0, 0.0, 0.0, 0.0]], spin[None], [DURATION])[0])[0]
        errors.append(float(max(abs(found[i, j] - turn[i, j]) for i in range(3) for j in range(3))))
        complements.append(float(complement))
    found = {"median_error": float(np.median(errors)), "largest_error": max(errors), "nearest": min(complements)}
    return {"moments": moments, "spins": spin_count, **found}


def main() -> None:
    options = command_line(__doc__, spins=40).parse_args()
    mp.dps = 40
    bodies = [accuracy(moments, options.spins) for moments in BODIES]
    for one in bodies:
        print(*one.values())
    made = origin(f"validation/tumbling_accuracy.py --spins {options.spins}")
    write_document(RESULTS, {**made, "rate_rad_s": RATE, "duration_s": DURATION, "bodies": bodies})


if __name__ == "__main__":
    main()
