"""All public names: of the package, of its public modules, and of its classes."""

import importlib
import inspect

import polhode as ph
from polhode._support.foreign_names import ForeignName

MODULES = ("torque", "force", "event", "io")


def public():
    """All public functions and classes by their names."""
    owners = [("", ph, ph.__all__)]
    for module in MODULES:
        owner = importlib.import_module(f"polhode.{module}")
        owners.append((f"{module}.", owner, [name for name in dir(owner) if not name.startswith("_")]))
    named = ((prefix + name, getattr(owner, name)) for prefix, owner, names in owners for name in names)
    return {name: found for name, found in named if inspect.isclass(found) or inspect.isroutine(found)}


def methods(found):
    """The public methods and properties of a class by name; no names of other libraries.

    They are its own and those of the classes that it extends, up to the first that is public itself.
    """
    members = {}
    for one in found.__mro__:
        own = one.__module__.startswith("polhode.") and getattr(ph, one.__name__, None) is not one
        if one is not found and not own:
            break
        members = {**vars(one), **members}
    return {
        name: member
        for name, member in members.items()
        if not name.startswith("_") and not isinstance(member, ForeignName)
    }
