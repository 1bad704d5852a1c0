"""
The operations of the intermediate form on unknown values, and when they are exact.
"""

from typing import Any

import z3

from stepgen.verify.proof.integers import Integer

COMPARISONS = {"==", "!=", "<", "<=", ">", ">="}


def operation(sign: str, one: Any, other: Any, kind: Integer) -> tuple[Any, Any]:  # noqa: ANN401
    """
    Return *one sign other* as the chip computes it, and when that is the true value.

    The second is None where it always is.
    """
    if sign in COMPARISONS:
        return z3.If(_comparison(sign, one, other, kind), _bit(1), _bit(0)), None
    if sign in {"&", "|", "^"}:
        return {"&": one & other, "|": one | other, "^": one ^ other}[sign], None
    if sign == ">>":
        return (one >> other if kind.signed else z3.LShR(one, other)), None
    if sign == "/":
        return (one / other if kind.signed else z3.UDiv(one, other)), other != 0
    if sign == "*":
        return one * other, _product_fits(one, other, kind)
    bits = 2 * kind.bits + 1
    wide = _exact(sign, kind.wide(one, bits), kind.wide(other, bits))
    value = z3.Extract(kind.bits - 1, 0, wide)
    return value, kind.wide(value, bits) == wide


def _exact(sign: str, one: Any, other: Any) -> Any:  # noqa: ANN401
    match sign:
        case "+":
            return one + other
        case "-":
            return one - other
        case "<<":
            return one << other
    raise ValueError(f"an operation {sign}")


def _product_fits(one: Any, other: Any, kind: Integer) -> Any:  # noqa: ANN401
    fits = z3.BVMulNoOverflow(one, other, kind.signed)
    return z3.And(fits, z3.BVMulNoUnderflow(one, other)) if kind.signed else fits


def _bit(value: int) -> Any:  # noqa: ANN401
    return z3.BitVecVal(value, 1)


def _comparison(sign: str, one: Any, other: Any, kind: Integer) -> Any:  # noqa: ANN401
    match sign:
        case "==":
            return one == other
        case "!=":
            return one != other
        case "<":
            return one < other if kind.signed else z3.ULT(one, other)
        case "<=":
            return one <= other if kind.signed else z3.ULE(one, other)
        case ">":
            return one > other if kind.signed else z3.UGT(one, other)
    return one >= other if kind.signed else z3.UGE(one, other)
