"""The compiled kernel's library: opened, asked whether it is the right one, its functions given their types."""

from __future__ import annotations

import ctypes
import platform
from pathlib import Path
from typing import Any

from .plan import FRONT, RUN

#: Of the structs and functions that Python and the library share (CURVEFOLD_ABI in plan.h).
ABI = 1

#: What ``curvefold_level`` says, by the machine's kind: x86-64 has two instruction sets, ARM one.
_X86_LEVELS, _ARM_LEVELS = ("AVX2", "AVX-512"), ("NEON",)

_i64, _address = ctypes.c_int64, ctypes.c_void_p


class KernelUnavailableError(Exception):
    """The kernel cannot be used here; the text says why, as the second half of a sentence."""


class PlanAddresses(ctypes.Structure):
    """``Plan`` of plan.h."""

    _fields_ = [
        *((name, _address) for name in ("fronts", "source", "target", "children", "runs", "indices")),
        *((name, _address) for name in ("panels", "updates", "carried", "scratch")),
        ("scratch_size", _i64),
    ]


class Library:
    """The functions of a library file. Raises KernelUnavailableError where it cannot be used."""

    def __init__(self, path: Path) -> None:
        try:
            library = ctypes.CDLL(str(path))
            layout, level = library.curvefold_layout, library.curvefold_level
            self.factor, self.forward = library.curvefold_factor, library.curvefold_forward
            self.backward = library.curvefold_backward
        except OSError as error:
            raise KernelUnavailableError(f"the compiled kernel cannot be loaded ({error})") from error
        except AttributeError as error:
            raise KernelUnavailableError("the compiled kernel lacks a function") from error
        said, expected = (_i64 * 4)(), [ABI, FRONT.itemsize, RUN.itemsize, ctypes.sizeof(PlanAddresses)]
        layout.argtypes, layout.restype = [_i64 * 4], None
        layout(said)
        if list(said) != expected:
            raise KernelUnavailableError("the compiled kernel is of another version")
        level.argtypes, level.restype = [], _i64
        self.level = int(level())
        if self.level < 1:
            raise KernelUnavailableError("this processor lacks AVX2, which the compiled kernel needs")
        call: list[Any] = [_address, _i64, _i64, _address, _i64]
        self.factor.argtypes, self.factor.restype = [*call, _address, _address], _i64
        self.forward.argtypes, self.forward.restype = [*call, _address], None
        self.backward.argtypes, self.backward.restype = [*call, _address], None

    @property
    def instructions(self) -> str:
        """The instruction set that is used, by its name."""
        x86 = platform.machine().lower() in ("x86_64", "amd64")
        return (_X86_LEVELS if x86 else _ARM_LEVELS)[self.level - 1]
