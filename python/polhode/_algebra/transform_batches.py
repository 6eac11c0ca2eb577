"""Transforms as values: immutable, with batches that are indexed, compared and shown."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NoReturn, Self

from polhode._algebra.format import first_and_last
from polhode._algebra.multivector import Multivector
from polhode._algebra.rotor import Rotor
from polhode._support.arrays import Shape


class TransformBatch:
    """A rotor and a translation of one batch shape: the base of `RigidTransform`."""

    __slots__ = ("rotor", "translation")

    rotor: Rotor
    translation: Multivector

    def _like(self, rotor: Rotor, translation: Multivector) -> Self:
        """Return a transform of these parts."""
        raise NotImplementedError

    def _set(self, rotor: Any, translation: Any) -> None:
        object.__setattr__(self, "rotor", rotor)
        object.__setattr__(self, "translation", translation)

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a RigidTransform is immutable; make a new one instead of setting {name!r}")

    def __delattr__(self, name: str) -> None:
        raise AttributeError("a RigidTransform is immutable")

    @property
    def shape(self) -> Shape:
        """Shape of the batch; ``()`` for one transform."""
        return self.rotor.shape

    @property
    def single(self) -> bool:
        """Whether this is one transform, not a batch."""
        return not self.shape

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError("a single transform has no length; only batches have")
        return self.shape[0]

    def __bool__(self) -> NoReturn:
        raise TypeError("a transform has no truth value; compare it with == or is_close")

    def __getitem__(self, index: Any) -> Self:
        if isinstance(index, str):
            raise TypeError(
                f"a transform has no component {index!r}; those of its parts are T.rotor[name] and "
                "T.translation[name]"
            )
        if not (self.shape or index is None or index is Ellipsis or isinstance(index, tuple)):
            raise IndexError(
                f"a single transform has no batch to index, got [{index!r}]; its parts are .rotor and "
                ".translation, its matrix .as_matrix()"
            )
        return self._like(self.rotor[index], self.translation[index])

    def __setitem__(self, index: Any, value: object) -> NoReturn:
        raise TypeError("transforms are immutable; join parts with RigidTransform.concatenate")

    def __iter__(self) -> Iterator[Self]:
        if not self.shape:
            raise TypeError("a single transform is not iterable; its parts are .as_components()")
        return (self[i] for i in range(len(self)))

    def __eq__(self, other: object) -> Any:
        """Return whether rotors and translations are equal, by element."""
        if not isinstance(other, TransformBatch):
            return NotImplemented
        return (self.rotor == other.rotor) & (self.translation == other.translation)

    __hash__ = None  # type: ignore[assignment]  # equality is by element

    def __repr__(self) -> str:
        return format(self)

    def __format__(self, spec: str) -> str:
        """Return the text with each component in this format: ``f"{T:.3f}"``."""
        if not self.shape:
            return f"RigidTransform(rotor={self.rotor:{spec}}, translation={self.translation:{spec}})"
        rows = first_and_last(
            self._reshaped((-1,)), lambda T: f"rotor={T.rotor:{spec}}, translation={T.translation:{spec}}"
        )
        return f"RigidTransform of shape {self.shape}:\n[" + ",\n ".join(rows) + "]"

    def _reshaped(self, shape: Sequence[int]) -> Self:
        return self._like(self.rotor.reshape(*shape), self.translation.reshape(*shape))
