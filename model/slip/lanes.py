# SPDX-License-Identifier: MIT
"""Lanes: several numbers side by side in vector registers, for numba's compiled loops.

A value of type `Lanes` holds `LANES` float64, one of each of as many independent computations. Its
operators and the functions below work on all of them by one instruction where the processor has
vector instructions. The same functions take a plain float, so that one source of a formula is
compiled for one computation or for `LANES`, by the type of the array that it reads:

====================  ==========================  ==================
`row(array, i)` of     an array of shape (n,)      (n, LANES)
====================  ==========================  ==================
is                     a float                     `Lanes`
a comparison gives     a bool                      `Mask`
====================  ==========================  ==================

Lanes exist only within compiled functions. Products and sums may be contracted to one rounding
where the processor has that instruction; nothing else is relaxed.
"""

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.imputils import lower_builtin
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, models, register_model

LANES = 4
"""Number of lanes: as many float64 as a vector register of AVX2 holds."""


# An intrinsic returns its signature and the function that emits its LLVM instructions. Calls of it
# leave out the first argument, numba's typing context.
_inline: Callable[..., Any] = intrinsic

_DOUBLE, _LONG = ir.DoubleType(), ir.IntType(64)
_CONTRACT = ("contract",)


class LanesType(types.Type):
    """numba's type of `LANES` float64 side by side."""

    def __init__(self) -> None:
        super().__init__(name=f"Lanes({LANES})")


class MaskType(types.Type):
    """numba's type of `LANES` truth values side by side."""

    def __init__(self) -> None:
        super().__init__(name=f"Mask({LANES})")


lanes, mask, one = LanesType(), MaskType(), types.float64


@register_model(LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.VectorType(_DOUBLE, LANES))


@register_model(MaskType)
class _MaskModel(models.PrimitiveModel):
    def __init__(self, manager, kind):
        super().__init__(manager, kind, ir.VectorType(ir.IntType(1), LANES))


def _vector(builder, context, kind, value):
    """Return an LLVM value of numba type `kind` as a vector: a number is repeated in all lanes."""
    if isinstance(kind, LanesType):
        return value
    value = context.cast(builder, value, kind, one)
    vector = ir.Constant(ir.VectorType(_DOUBLE, LANES), ir.Undefined)
    for lane in range(LANES):
        vector = builder.insert_element(vector, value, ir.Constant(ir.IntType(32), lane))
    return vector


def _operator(op: Callable, emit: Callable, result: types.Type) -> None:
    """Register an operator with numba for two `Lanes`, or a float and `Lanes`.

    Args:
        op: Python's operator, such as `operator.add`.
        emit: Function that emits its LLVM instruction from the builder and two vectors.
        result: numba's type of the result.
    """
    pairs = [(lanes, lanes), (lanes, one), (one, lanes)]

    @infer_global(op)  # pyright: ignore[reportOptionalCall] its stub lacks it
    class _Typed(ConcreteTemplate):
        cases = [signature(result, *pair) for pair in pairs]  # noqa: RUF012 numba's own way

    def lower(context, builder, sig, args):
        left, right = (
            _vector(builder, context, *each) for each in zip(sig.args, args, strict=True)
        )
        return emit(builder, left, right)

    for pair in pairs:
        lower_builtin(op, *pair)(lower)


def _compared(sign: str) -> Callable:
    """Return the function that emits a comparison, "<" or ">", which is false for NaN."""
    return lambda builder, a, b: builder.fcmp_ordered(sign, a, b)


_operator(operator.add, lambda b, x, y: b.fadd(x, y, flags=_CONTRACT), lanes)
_operator(operator.sub, lambda b, x, y: b.fsub(x, y, flags=_CONTRACT), lanes)
_operator(operator.mul, lambda b, x, y: b.fmul(x, y, flags=_CONTRACT), lanes)
_operator(operator.truediv, lambda b, x, y: b.fdiv(x, y), lanes)
for _op, _sign in ((operator.lt, "<"), (operator.gt, ">")):
    _operator(_op, _compared(_sign), mask)


@infer_global(operator.neg)  # pyright: ignore[reportOptionalCall] its stub lacks it
class _Negated(ConcreteTemplate):
    cases = [signature(lanes, lanes)]  # noqa: RUF012 numba's own way


@lower_builtin(operator.neg, lanes)
def _negate(context, builder, sig, args):
    """Emit the change of sign of all lanes."""
    return builder.fneg(args[0])


def _place(context, builder, array_type, array, index):
    """Return an LLVM pointer to row `index` of an array: to a float, or to a vector of the lanes.

    The array must be C-contiguous and a row of a 2-D one `LANES` long: strides are not looked at.
    """
    struct = context.make_array(array_type)(context, builder, array)  # numba's, with `data`
    if array_type.ndim == 1:
        return builder.gep(struct.data, [index])
    first = builder.mul(index, ir.Constant(_LONG, LANES))
    pointer = builder.gep(struct.data, [first])
    return builder.bitcast(pointer, ir.VectorType(_DOUBLE, LANES).as_pointer())


def _element(array_type):
    """Return numba's type of an array's row: float64 of a 1-D array, `Lanes` of a 2-D one."""
    return one if array_type.ndim == 1 else lanes


@_inline
def row(typing, array, index):
    """Return row `index` of an array of shape (n,), a float, or of (n, LANES), `Lanes`."""

    def emit(context, builder, sig, args):
        at = context.cast(builder, args[1], sig.args[1], types.intp)
        loaded = builder.load(_place(context, builder, sig.args[0], args[0], at))
        loaded.align = 8  # numpy aligns its arrays to a float64, not to a vector
        return loaded

    return _element(array)(array, index), emit


@_inline
def put(typing, array, index, value):
    """Store a float or `Lanes` in row `index` of an array of shape (n,) or (n, LANES)."""
    kind = _element(array)

    def emit(context, builder, sig, args):
        at = context.cast(builder, args[1], sig.args[1], types.intp)
        stored = args[2]
        if isinstance(kind, LanesType):
            stored = _vector(builder, context, sig.args[2], stored)
        builder.store(stored, _place(context, builder, sig.args[0], args[0], at)).align = 8
        return context.get_dummy_value()

    return types.void(array, index, value), emit


@_inline
def select(typing, where, yes, no):
    """Return `yes` where a bool or `Mask` is true, else `no`, without a branch."""
    kind = lanes if isinstance(where, MaskType) else one

    def emit(context, builder, sig, args):
        picked = args[1:]
        if isinstance(kind, LanesType):
            picked = [
                _vector(builder, context, k, a) for k, a in zip(sig.args[1:], args[1:], strict=True)
            ]
        return builder.select(args[0], *picked)

    if kind == one:
        return kind(types.boolean, one, one), emit
    return kind(where, yes, no), emit


def _rounded(name: str, doc: str) -> Callable[..., Any]:
    """Return a function of a float or `Lanes` that calls the LLVM intrinsic `llvm.{name}`."""

    def typed(typing, x):
        def emit(context, builder, sig, args):
            kind = args[0].type
            suffix = "f64" if kind == _DOUBLE else f"v{LANES}f64"
            called = cgutils.get_or_insert_function(
                builder.module, ir.FunctionType(kind, [kind]), f"llvm.{name}.{suffix}"
            )
            return builder.call(called, args)

        return (lanes if isinstance(x, LanesType) else one)(x), emit

    typed.__doc__, typed.__name__ = doc, name
    return _inline(typed)


nearest = _rounded("rint", "Return the whole number nearest to a float or each of `Lanes`.")
size = _rounded("fabs", "Return the absolute value of a float or of each of the `Lanes`.")


def _long_like(kind, value):
    """Return a 64-bit integer constant, in all lanes where the LLVM type `kind` is a vector."""
    if isinstance(kind, ir.VectorType):
        return ir.Constant(ir.VectorType(_LONG, LANES), [value] * LANES)
    return ir.Constant(_LONG, value)


_SPLIT = 0x3FE6A09E << 32  # bits of the float at which mantissas are split: sqrt(1/2)
_ONE = 0x3FF0 << 48  # bits of 1.0
_WHOLE = 0x4330 << 48  # bits of 2^52: a float from there on counts whole numbers in its last bits


@_inline
def exponent_and_mantissa(typing, x):
    """Split positive floats: x = 2^e m, with whole e and m from sqrt(1/2) to sqrt(2)."""

    def emit(context, builder, sig, args):
        kind = args[0].type
        whole = ir.VectorType(_LONG, LANES) if isinstance(kind, ir.VectorType) else _LONG
        bits = builder.add(builder.bitcast(args[0], whole), _long_like(kind, _ONE - _SPLIT))
        biased = builder.or_(builder.lshr(bits, _long_like(kind, 52)), _long_like(kind, _WHOLE))
        magic = builder.bitcast(_long_like(kind, _WHOLE + 1023), kind)  # 2^52 + 1023, the bias
        exponent = builder.fsub(builder.bitcast(biased, kind), magic)
        rest = builder.and_(bits, _long_like(kind, (1 << 52) - 1))
        mantissa = builder.bitcast(builder.add(rest, _long_like(kind, _SPLIT)), kind)
        return context.make_tuple(builder, sig.return_type, (exponent, mantissa))

    kind = lanes if isinstance(x, LanesType) else one
    return types.UniTuple(kind, 2)(x), emit


@_inline
def power_of_two(typing, k):
    """Return 2^k of whole numbers k from -1022 to 1023, a float or `Lanes`."""

    def emit(context, builder, sig, args):
        kind = args[0].type
        whole = ir.VectorType(_LONG, LANES) if isinstance(kind, ir.VectorType) else _LONG
        # k + 2^52 + 1023 has the biased exponent k + 1023 in its last bits; they are shifted up.
        magic = builder.bitcast(_long_like(kind, _WHOLE + 1023), kind)
        bits = builder.bitcast(builder.fadd(args[0], magic), whole)
        return builder.bitcast(builder.shl(bits, _long_like(kind, 52)), kind)

    return (lanes if isinstance(k, LanesType) else one)(k), emit
