"""Products of vectors and matrices on scalars, for use inside compiled kernels."""

from typing import Any

from lithobrake.compilation.compiled import kernel

Vector = tuple[float, float, float]


@kernel
def dot(a: Vector, b: Vector) -> float:
    """Return a . b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


@kernel
def plus(a: Vector, b: Vector) -> Vector:
    """Return a + b."""
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


@kernel
def minus(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


@kernel
def scaled(factor: float, a: Vector) -> Vector:
    """Return factor * a."""
    return (factor * a[0], factor * a[1], factor * a[2])


@kernel
def tangential_part(vector: Vector, normal: Vector) -> Vector:
    """Return the part of a vector across the normal."""
    return minus(vector, scaled(dot(vector, normal), normal))


@kernel
def row(array: Any, i: int) -> Vector:
    """Return row i of an array [count, 3]."""
    return (array[i, 0], array[i, 1], array[i, 2])


@kernel
def put(array: Any, i: int, a: Vector) -> None:
    """Write row i of an array [count, 3]."""
    array[i, 0], array[i, 1], array[i, 2] = a


@kernel
def add(array: Any, i: int, factor: float, a: Vector) -> None:
    """Add factor * a to row i of an array [count, 3]."""
    array[i, 0] += factor * a[0]
    array[i, 1] += factor * a[1]
    array[i, 2] += factor * a[2]


@kernel
def times(matrices: Any, i: int, a: Vector) -> Vector:
    """Return M a with M = matrices[i], from an array [count, 3, 3]."""
    m = matrices[i]
    return (
        m[0, 0] * a[0] + m[0, 1] * a[1] + m[0, 2] * a[2],
        m[1, 0] * a[0] + m[1, 1] * a[1] + m[1, 2] * a[2],
        m[2, 0] * a[0] + m[2, 1] * a[1] + m[2, 2] * a[2],
    )


@kernel
def transposed_times(matrices: Any, i: int, a: Vector) -> Vector:
    """Return M^T a with M = matrices[i], from an array [count, 3, 3]."""
    m = matrices[i]
    return (
        m[0, 0] * a[0] + m[1, 0] * a[1] + m[2, 0] * a[2],
        m[0, 1] * a[0] + m[1, 1] * a[1] + m[2, 1] * a[2],
        m[0, 2] * a[0] + m[1, 2] * a[1] + m[2, 2] * a[2],
    )
