"""Types of the arrays of kernels, and arithmetic that a compiler can run on several points at once."""

from typing import Any

from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from lithobrake.compilation.compiled import compiled

LANES = 32  # points that share one pass over the facets; 1000 vertex distances of 32 points fit the second-level cache
WIDTH = 8  # doubles in the widest registers

_HALF = 1 << 51  # half a unit of the exponent field of a double
_EXPONENT = 0x7FF << 52
_ONE = 1023 << 52
_SHIFT = 0x4338000000000000  # the bits of 1.5 * 2**52, to which a small integer can be added as bits
_SHIFT_VALUE = 6755399441055744.0
_LN2 = 0.6931471805599453
_QUARTER_PI = 0.7853981633974483
_HALF_PI = 1.5707963267948966
_TAN_EIGHTH_PI = 0.41421356237309503


def _fma(_context: Any, a: Any, b: Any, c: Any) -> Any:
    def build(_inner: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.fma(*arguments)

    return types.float64(types.float64, types.float64, types.float64), build


def _to_bits(_context: Any, value: Any) -> Any:
    def build(_inner: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.IntType(64))

    return types.int64(types.float64), build


def _from_bits(_context: Any, value: Any) -> Any:
    def build(_inner: Any, builder: Any, _signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], ir.DoubleType())

    return types.float64(types.int64), build


# Inside kernels only: a * b + c rounded once; the 64 bits of a double as an integer; the double of an integer's bits.
fma: Any = intrinsic(_fma)
to_bits: Any = intrinsic(_to_bits)
from_bits: Any = intrinsic(_from_bits)


@compiled
def log_ratio(total: float, part: float) -> float:
    """ln((total + part) / (total - part)) for 0 <= part <= total, to about 1e-16; large, not infinite, at part = total.

    With (total + part)/(total - part) = 2**k * q and q near one, ln q = 2 atanh(s), s = (q - 1)/(q + 1). For k = 0 the
    numerator is 2 part exactly, which keeps the digits of far points. The polynomial is the Chebyshev interpolant of
    (atanh(s) - s)/s**3 on s**2 < 0.0404.
    """
    above = total + part
    # The floor bounds the logarithm at 37: it meets a factor that is zero there, and zero times 37 is the limit.
    below = max(total - part, 1e-16 * total)
    shift = (to_bits(above) - to_bits(below) + _HALF) & _EXPONENT
    power = from_bits(shift + _ONE)
    numerator = 2.0 * part if shift == 0 else fma(-power, below, above)
    s = numerator / fma(power, below, above)
    u = s * s
    p = fma(u, 0.07566458904987829, 0.07641053892322244)
    p = fma(p, u, 0.09092337939287172)
    p = fma(p, u, 0.11111090772688173)
    p = fma(p, u, 0.14285714423177434)
    p = fma(p, u, 0.19999999999652246)
    p = fma(p, u, 0.33333333333333476)
    count = from_bits((shift >> 52) + _SHIFT) - _SHIFT_VALUE
    return fma(count, _LN2, 2.0 * fma(s * u, p, s))


@compiled
def angle(y: float, x: float) -> float:
    """atan2(y, x) to about 2e-16, and 0 for (0, 0); the sign of a zero y does not matter.

    The smaller magnitude over the larger lies in [0, 1]; above tan(pi/8) it is turned back by pi/4. The polynomial is
    the Chebyshev interpolant of (atan(t) - t)/t**3 on t**2 < 0.1716.
    """
    up = abs(y)
    along = abs(x)
    small = min(up, along)
    large = max(up, along)
    turned = small > _TAN_EIGHTH_PI * large
    numerator = small - large if turned else small
    # The smallest normal number only matters where both are zero: the quotient is then zero, not undefined.
    t = numerator / ((small + large if turned else large) + 2.2250738585072014e-308)
    u = t * t
    p = fma(u, -0.019176200000260032, 0.039231092557972545)
    p = fma(p, u, -0.05085429969845785)
    p = fma(p, u, 0.05858145093804676)
    p = fma(p, u, -0.06664511002023797)
    p = fma(p, u, 0.07692183158699298)
    p = fma(p, u, -0.09090904576712286)
    p = fma(p, u, 0.11111111015220662)
    p = fma(p, u, -0.14285714284666082)
    p = fma(p, u, 0.19999999999995519)
    p = fma(p, u, -0.3333333333333333)
    result = fma(t * u, p, t) + (_QUARTER_PI if turned else 0.0)
    result = _HALF_PI - result if up > along else result
    result = 2.0 * _HALF_PI - result if x < 0.0 else result
    return -result if y < 0.0 else result
