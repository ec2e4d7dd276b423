"""Errors with a place: what is wrong, in which file, at which element, and where on the sheet."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Where:
    """Where something is wrong. Every field may be unknown (None)."""

    file: str | None = None
    element: str | None = None
    place: tuple[float, ...] | None = None  # in the drawing's own units

    def __str__(self) -> str:
        parts = []
        if self.file is not None:
            parts.append(self.file)
        if self.element is not None:
            parts.append(self.element)
        text = ", ".join(parts)
        if self.place is not None:
            coordinates = ", ".join(f"{value:.6g}" for value in self.place)
            text = f"{text} at ({coordinates})".strip()
        return text


class CurvefoldError(Exception):
    """Base of all errors that a user can cause. ``str()`` is one sentence that says where and what.

    notes: what was decided before it went wrong, one sentence each, as far as that helps to understand it
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        element: str | None = None,
        place: tuple[float, ...] | None = None,
        notes: tuple[str, ...] = (),
    ) -> None:
        self.message = message
        self.where = Where(file, element, place)
        self.notes = notes
        super().__init__(message)

    def __str__(self) -> str:
        where = str(self.where)
        text = f"{where}: {self.message}" if where else self.message
        # Names of files, elements and settings may hold line breaks of all kinds.
        return " ".join(text.splitlines())

    def in_file(self, file: str) -> CurvefoldError:
        """The same error, of the same type, naming ``file``."""
        return type(self)(
            self.message, file=file, element=self.where.element, place=self.where.place, notes=self.notes
        )

    def with_notes(self, notes: tuple[str, ...]) -> CurvefoldError:
        """The same error, of the same type, with ``notes`` before its own."""
        where = self.where
        return type(self)(
            self.message, file=where.file, element=where.element, place=where.place, notes=(*notes, *self.notes)
        )


class ReadError(CurvefoldError):
    """A file cannot be read as what it claims to be."""


class PatternError(CurvefoldError):
    """A drawing is not a crease pattern: no border, nothing to fold, not finite, ..."""


class NetError(CurvefoldError):
    """A crease pattern cannot carry a net at the asked resolution."""


class HandleError(CurvefoldError):
    """A handle cannot be used: off the sheet, not finite, contradicting another one."""


class DescriptionError(CurvefoldError):
    """A fold description (its numbers or its words) is not valid."""


class NotPositiveDefiniteError(CurvefoldError):
    """The reduced system could not be factorised."""
