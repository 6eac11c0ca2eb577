"""Fused multiply-adds in the kernel for GPUs.

XLA compiles each product and each sum in a Pallas kernel to an instruction of its own, where a GPU has one
instruction for both, with one rounding. So `fused` traces the program of a step, and evaluates it with each
product that a sum alone uses joined to that sum: a third fewer instructions.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from typing import Any

from polhode._support.extras import optional
from polhode.jax._library import Array, jax, jnp, lax

# ``f(a, b, c, signs)`` is ``±a b ± c`` with the signs of the product and of c, "+" or "-".
MultiplyAdd = Callable[[Array, Array, Array, tuple[str, str]], Array]

_TYPES = {"float32": "f", "float64": "d"}
_CALLS = ("jit", "pjit", "closed_call", "custom_jvp_call", "custom_vjp_call")


def fused(function: Callable[..., Any], multiply_add: MultiplyAdd | None = None) -> Callable[..., Any]:
    """Return the function of pytrees of arrays with fused multiply-adds, for the body of a kernel."""
    join = instruction if multiply_add is None else multiply_add

    def evaluated(*arguments: Any) -> Any:
        program, shape = jax.make_jaxpr(function, return_shape=True)(*arguments)
        found = _evaluated(program.jaxpr, program.consts, jax.tree.leaves(arguments), join)
        return jax.tree.unflatten(jax.tree.structure(shape), found)

    return evaluated


def instruction(a: Array, b: Array, c: Array, signs: tuple[str, str]) -> Array:
    """Return ``±a b ± c`` by the instruction of NVIDIA's GPUs, which negates at no cost."""
    triton = optional("jax.experimental.pallas.triton", "jax", "the kernel of polhode.jax")
    letter, kind = _TYPES[a.dtype.name], f"f{8 * a.dtype.itemsize}"
    text = f"fma.rn.{kind} $0, $1, $2, $3;"
    for place, register, sign in zip(("$1", "$3"), "ac", signs, strict=True):
        if sign == "-":
            text = f".reg .{kind} {register}; neg.{kind} {register}, {place}; {text.replace(place, register)}"
    (result,) = triton.elementwise_inline_asm(
        f"{{ {text} }}",
        args=[a, b, c],
        constraints=",".join([f"={letter}", letter, letter, letter]),
        pack=1,
        result_shape_dtypes=[jax.ShapeDtypeStruct(a.shape, a.dtype)],
    )
    return result


def _evaluated(program: Any, constants: Any, arguments: Any, join: MultiplyAdd) -> list[Any]:
    """Evaluate a program; a product that one sum alone uses waits for that sum."""
    uses = Counter(x for equation in program.eqns for x in equation.invars if _is_variable(x))
    uses.update(x for x in program.outvars if _is_variable(x))
    values = dict(zip([*program.constvars, *program.invars], [*constants, *arguments], strict=True))
    products: dict[Any, tuple[Any, Any]] = {}

    def value(x: Any) -> Any:
        if not _is_variable(x):
            return x.val
        if x in products:
            a, b = products.pop(x)
            values[x] = lax.mul(a, b)
        return values[x]

    for equation in program.eqns:
        name, out = equation.primitive.name, equation.outvars[0]
        if name == "mul" and uses[out] == 1 and _is_fusible(out.aval):
            products[out] = tuple(jnp.broadcast_to(value(x), out.aval.shape) for x in equation.invars)
            continue
        if name in ("add", "sub") and any(_is_variable(x) and x in products for x in equation.invars):
            values[out] = _joined(equation, products, value, join)
            continue
        given = [value(x) for x in equation.invars]
        values.update(zip(equation.outvars, _found(equation, given, join), strict=True))
    return [value(x) for x in program.outvars]


def _joined(equation: Any, products: Any, value: Callable[[Any], Any], join: MultiplyAdd) -> Any:
    """Return the sum or difference of a waiting product and another value."""
    left, right = equation.invars
    difference = equation.primitive.name == "sub"
    # Of two products the second is joined, and the first is rounded.
    if _is_variable(right) and right in products:
        a, b = products.pop(right)
        other, signs = left, ("-" if difference else "+", "+")
    else:
        a, b = products.pop(left)
        other, signs = right, ("+", "-" if difference else "+")
    c = jnp.broadcast_to(jnp.asarray(value(other), a.dtype), a.shape)
    return join(a, b, c, signs)


def _found(equation: Any, given: list[Any], join: MultiplyAdd) -> list[Any]:
    """Evaluate an equation; loops and calls by the equations inside."""
    name, options = equation.primitive.name, equation.params
    if name in _CALLS:
        inner = options["call_jaxpr"] if "call_jaxpr" in options else options["jaxpr"]
        return _evaluated(getattr(inner, "jaxpr", inner), getattr(inner, "consts", ()), given, join)
    if name == "scan" and _is_loop(equation):
        inner, fixed = options["jaxpr"], options["num_consts"]

        def one(carry: Any, _: None) -> tuple[Any, None]:
            return tuple(_evaluated(inner.jaxpr, inner.consts, [*given[:fixed], *carry], join)), None

        return list(lax.scan(one, tuple(given[fixed:]), None, length=options["length"])[0])
    bound = equation.primitive.get_bind_params(options)
    # Older versions of JAX return functions beside the options.
    functions, options = bound if isinstance(bound, tuple) else ((), bound)
    found = equation.primitive.bind(*functions, *given, **options)
    return list(found) if equation.primitive.multiple_results else [found]


def _is_loop(scan: Any) -> bool:
    """Return whether a scan has a state only, as that of ``fori_loop``."""
    fixed, carried = scan.params["num_consts"], scan.params["num_carry"]
    return fixed + carried == len(scan.invars) and carried == len(scan.outvars) and not scan.params["reverse"]


def _is_variable(x: Any) -> bool:
    return not hasattr(x, "val")


def _is_fusible(aval: Any) -> bool:
    """Return whether these are values of bodies, of a type with the instruction."""
    return aval.shape != () and aval.dtype.name in _TYPES
