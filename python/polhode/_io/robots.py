"""Bodies as URDF and MJCF files: mass, centre of mass and inertia of each link."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np

from polhode import _native
from polhode._mechanics.bodies import Body
from polhode._support.calls import explains_calls
from polhode._support.files import write_atomically

# The root link of a URDF file, from which the bodies are free.
_ROOT = "world"
# MuJoCo rejects a mass or moment of a moving body that is not above this (its mjMINVAL).
_LEAST = 1e-15


@explains_calls
def write_urdf(
    bodies: Body | Mapping[str, Body], path: str | os.PathLike[str], *, name: str = "body"
) -> None:
    """Write bodies as the links of a URDF file, atomically.

    The axes of a link are the body axes. Its inertial element has the mass (kg), the centre of mass (m) and
    the inertia matrix about it (kg m²), with axes parallel to those of the link. Each link is joined to an
    empty root link ``world`` by a floating joint at the origin; there are no shapes. `polhode.read_urdf`
    reads the same numbers back. MuJoCo may reject a flat body in URDF, by rounding; `write_mjcf` prevents it.

    Parameters
    ----------
    bodies
        A body, or bodies by the names of their links.
    name
        Name of the robot, and of the link of a single body.

    Raises
    ------
    ValueError
        If there is no body, or a name is empty, ``world``, or cannot be in XML.
    OSError
        If the file cannot be written; an older file stays.

    Examples
    --------
    >>> wheel, axle = ph.Body.disc(0.5, mass=2), ph.Body.cylinder(0.05, 1, mass=3)
    >>> ph.io.write_urdf({"wheel": wheel, "axle": axle}, "cart.urdf")
    >>> ph.read_urdf("cart.urdf")["wheel"] == wheel
    True
    """
    links = _named(bodies, name)
    if _ROOT in links:
        raise ValueError(f"no link may be called {_ROOT!r}, the name of the root link; choose another name")
    lines = [f"<robot name={quoteattr(name)}>", f'  <link name="{_ROOT}"/>']
    for link, body in links.items():
        matrix, label = body.inertia.matrix, quoteattr(link)
        entries = {"xx": (0, 0), "xy": (0, 1), "xz": (0, 2), "yy": (1, 1), "yz": (1, 2), "zz": (2, 2)}
        inertia = " ".join(f'i{entry}="{float(matrix[at])!r}"' for entry, at in entries.items())
        lines += [
            f"  <link name={label}>",
            "    <inertial>",
            f'      <origin xyz="{_center(body)}" rpy="0 0 0"/>',
            f'      <mass value="{body.mass!r}"/>',
            f"      <inertia {inertia}/>",
            "    </inertial>",
            "  </link>",
            f'  <joint name={label} type="floating">',
            f'    <parent link="{_ROOT}"/>',
            f"    <child link={label}/>",
            "  </joint>",
        ]
    _write(path, [*lines, "</robot>"])


@explains_calls
def write_mjcf(
    bodies: Body | Mapping[str, Body], path: str | os.PathLike[str], *, name: str = "body"
) -> None:
    """Write bodies as the bodies of an MJCF file, a model of MuJoCo, atomically.

    The axes of an MJCF body are the body axes. Its inertial element has the mass (kg), the centre of mass
    (m), the principal moments (kg m²) and the quaternion, w first, that turns the principal axes into the
    body axes. Each body has a free joint and starts with its axes on those of the world; there are no geoms.
    Gravity is MuJoCo's default. `polhode.read_mjcf` reads the bodies back.

    Parameters
    ----------
    bodies
        A body, or bodies by name.
    name
        Name of the model, and of a single body.

    Raises
    ------
    ValueError
        If there is no body, or a name is empty, ``world``, or cannot be in XML; for a mass or a moment up to
        1e-15, as that of a thin rod about its axis, which MuJoCo rejects.
    OSError
        If the file cannot be written; an older file stays.

    Examples
    --------
    >>> wheel, axle = ph.Body.disc(0.5, mass=2), ph.Body.cylinder(0.05, 1, mass=3)
    >>> ph.io.write_mjcf({"wheel": wheel, "axle": axle}, "cart.xml")
    >>> sorted(ph.read_mjcf("cart.xml"))
    ['axle', 'wheel']
    """
    links = _named(bodies, name)
    if _ROOT in links:
        raise ValueError(f"no body may be called {_ROOT!r}, as MuJoCo calls its own; choose another name")
    lines = [f"<mujoco model={quoteattr(name)}>", "  <worldbody>"]
    for link, body in links.items():
        frame = body.inertia.principal_frame.to_quaternion(order="wxyz")
        lines += [
            f"    <body name={quoteattr(link)}>",
            "      <freejoint/>",
            f'      <inertial pos="{_center(body)}" quat="{_words(frame)}" mass="{body.mass!r}"'
            f' diaginertia="{_words(_moments(link, body))}"/>',
            "    </body>",
        ]
    _write(path, [*lines, "  </worldbody>", "</mujoco>"])


def _moments(name: str, body: Body) -> list[float]:
    """Return principal moments that MuJoCo accepts."""
    moments = [float(x) for x in body.inertia.principal_moments]
    for what, least in (("mass", body.mass), ("a principal moment", min(moments))):
        if not least > _LEAST:
            unit = "kg" if what == "mass" else "kg m²"
            raise ValueError(
                f"{name!r} has {what} of {least:g} {unit}, and MuJoCo needs more than {_LEAST:g}; "
                "give the body a thickness, or larger units"
            )
    # The largest moment of a flat body may exceed the sum of the others by rounding, which MuJoCo rejects.
    k = int(np.argmax(moments))
    moments[k] = min(moments[k], sum(x for i, x in enumerate(moments) if i != k))
    return moments


def _named(bodies: Body | Mapping[str, Body], name: str) -> dict[str, Body]:
    links = {name: bodies} if isinstance(bodies, Body) else bodies
    if not isinstance(links, Mapping):
        raise TypeError(f"expected a Body, or a dict of bodies by name, got {type(bodies).__name__}")
    links = dict(links)
    if not links:
        raise ValueError("there is no body to write; give a Body, or a dict of bodies by name")
    for link, body in links.items():
        if not isinstance(body, Body):
            raise TypeError(f"{link!r} must be a Body, got {type(body).__name__}")
    for word in (name, *links):
        if not isinstance(word, str) or not word.strip() or not word.isprintable():
            raise ValueError(f"a name must be printable text that is not empty, got {word!r}")
    return links


def _center(body: Body) -> str:
    return _words(body.center_of_mass.components)


def _words(numbers: object) -> str:
    return " ".join(repr(x) for x in np.asarray(numbers, float).tolist())


def _write(path: str | os.PathLike[str], lines: list[str]) -> None:
    head = ['<?xml version="1.0" encoding="utf-8"?>', f"<!-- Written by polhode {_native.__version__} -->"]
    write_atomically({Path(path): "\n".join([*head, *lines, ""]).encode()})
