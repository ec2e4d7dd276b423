"""BLAS and LAPACK without the GIL: scipy's own function pointers, called through ctypes.

``scipy.linalg.cython_blas`` and ``cython_lapack`` publish the addresses of all routines in ``__pyx_capi__``
for other compiled modules. ctypes can call them as well, drops the GIL meanwhile, and costs half a
microsecond a call. Nothing is compiled and nothing is added to numpy and scipy.
"""

from __future__ import annotations

import contextlib
import ctypes
import sys
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

# Takes what ``argument`` makes, nothing else: no types are declared, so none are checked.
Routine = Callable[..., None]

# Number of arguments of every routine used, from the reference BLAS and LAPACK documentation.
_BLAS_ARGUMENTS = {"dgemv": 11, "dsyrk": 10, "dtrmm": 11, "dtrmv": 8}
_LAPACK_ARGUMENTS = {"dpotrf": 5, "dtrtri": 6}

# OpenBLAS spells its thread count in as many ways as it has builds: scipy's wheels, plain, 64-bit integers.
_THREAD_COUNT_NAMES = (
    "scipy_openblas_{}_num_threads",
    "scipy_openblas_{}_num_threads64_",
    "openblas_{}_num_threads",
    "openblas_{}_num_threads64_",
)
# OpenBLAS's matrix addition, no part of BLAS: C = alpha A + beta C, eight arguments as in its interface/geadd.c.
# Two to four times faster than numpy's on small blocks, and the same to the last bit for alpha = beta = 1.
_ADDITION_NAMES = ("scipy_dgeadd_", "dgeadd_")


class LapackUnavailableError(Exception):
    """scipy's function pointers are not there, or do not look as expected."""


def argument(address: int) -> Any:
    """What a routine is called with to be given ``address``.

    ctypes passes a reference on as it is, in half the time of a number that it has to convert. What counts is
    the time with the GIL held: two lanes of short calls otherwise wait for each other most of the time.
    """
    return ctypes.byref(ctypes.c_char.from_address(address))


class Routines:
    """The BLAS and LAPACK routines that the factorisation calls; every argument is an ``argument``.

    Integers should be stored in eight bytes, which little-endian machines read right as C int as well as
    in builds with 64-bit integers. ``geadd`` is None where OpenBLAS's addition is not there.
    Raises LapackUnavailableError when a pointer is missing or has an unexpected number of arguments.
    """

    def __init__(self) -> None:
        try:
            import scipy.linalg.cython_blas as blas
            import scipy.linalg.cython_lapack as lapack

            self.gemv = _routine(blas, "dgemv", _BLAS_ARGUMENTS["dgemv"])
            self.syrk = _routine(blas, "dsyrk", _BLAS_ARGUMENTS["dsyrk"])
            self.trmm = _routine(blas, "dtrmm", _BLAS_ARGUMENTS["dtrmm"])
            self.trmv = _routine(blas, "dtrmv", _BLAS_ARGUMENTS["dtrmv"])
            self.potrf = _routine(lapack, "dpotrf", _LAPACK_ARGUMENTS["dpotrf"])
            self.trtri = _routine(lapack, "dtrtri", _LAPACK_ARGUMENTS["dtrtri"])
        except (ImportError, AttributeError, KeyError, TypeError, ValueError) as error:
            raise LapackUnavailableError(str(error)) from error
        libraries = _loaded_libraries(Path(blas.__file__ or ""))
        self.geadd = _addition(libraries)
        self.blas_threads = BlasThreads(libraries)


def _routine(module: Any, name: str, arguments: int) -> Routine:
    capsule = module.__pyx_capi__[name]
    get_name = ctypes.pythonapi.PyCapsule_GetName
    get_name.restype, get_name.argtypes = ctypes.c_char_p, [ctypes.py_object]
    get_pointer = ctypes.pythonapi.PyCapsule_GetPointer
    get_pointer.restype, get_pointer.argtypes = ctypes.c_void_p, [ctypes.py_object, ctypes.c_char_p]
    signature = get_name(capsule)  # such as b"void (char *, int *, __pyx_t_..._d *, int *, int *)"
    counts = signature.count(b"*"), signature.count(b",") + 1
    if sys.byteorder != "little" or counts != (arguments, arguments):
        raise ValueError(f"{name} has the unexpected signature {signature!r}")
    return _callable(int(get_pointer(capsule, signature)))


def _callable(address: int) -> Routine:
    routine: Routine = ctypes.CFUNCTYPE(None)(address)
    return routine


def _addition(libraries: list[ctypes.CDLL]) -> Routine | None:
    for library in libraries:
        for name in _ADDITION_NAMES:
            function = getattr(library, name, None)
            if function is not None:
                address = ctypes.cast(function, ctypes.c_void_p).value
                assert address is not None
                routine = _callable(address)
                return routine if _adds_right(routine) else None
    return None


def _adds_right(routine: Routine) -> bool:
    """Whether it adds a column of two to a column of two, as asked."""
    rows, cols, stride = ctypes.c_int64(2), ctypes.c_int64(1), ctypes.c_int64(2)
    one, pair = ctypes.c_double(1.0), ctypes.c_double * 2
    source, target = pair(1.0, 2.0), pair(3.0, 5.0)
    arguments = (rows, cols, one, source, stride, one, target, stride)
    routine(*(ctypes.byref(value) for value in arguments))
    return list(target) == [4.0, 7.0]


class BlasThreads:
    """Holds scipy's OpenBLAS to one thread while small blocks are worked on.

    On blocks of a hundred rows its spinning threads cost far more than they bring. Does nothing where
    scipy stands on another library (Accelerate, MKL), whose small blocks are single-threaded anyway.
    """

    def __init__(self, libraries: list[ctypes.CDLL]) -> None:
        self._lock = threading.Lock()
        self._users = 0
        self._before = 1
        self._set, self._get = _thread_count_functions(libraries)

    @property
    def available(self) -> bool:
        """Whether the number of threads can be changed at all."""
        return self._set is not None and self._get is not None

    @contextlib.contextmanager
    def single(self) -> Iterator[None]:
        """One BLAS thread inside the block; the former number again when its last user leaves."""
        if self._set is None or self._get is None:
            yield
            return
        with self._lock:
            if self._users == 0:
                self._before = max(int(self._get()), 1)
                if self._before > 1:
                    self._set(1)
            self._users += 1
        try:
            yield
        finally:
            with self._lock:
                self._users -= 1
                if self._users == 0 and self._before > 1:
                    self._set(self._before)


def _thread_count_functions(
    libraries: list[ctypes.CDLL],
) -> tuple[Callable[[int], Any] | None, Callable[[], int] | None]:
    for library in libraries:
        for name in _THREAD_COUNT_NAMES:
            setter = getattr(library, name.format("set"), None)
            getter = getattr(library, name.format("get"), None)
            if setter is not None and getter is not None:
                setter.argtypes, setter.restype = [ctypes.c_int], None
                getter.argtypes, getter.restype = [], ctypes.c_int
                return setter, getter
    return None, None


def _loaded_libraries(extension: Path) -> list[ctypes.CDLL]:
    """The libraries that scipy's BLAS may live in, opened again (they are in the process already)."""
    loaded = []
    for path in _candidate_libraries(extension):
        with contextlib.suppress(OSError):
            loaded.append(ctypes.CDLL(str(path)))
    return loaded


def _candidate_libraries(extension: Path) -> list[Path]:
    package = extension.parent.parent  # scipy/linalg/cython_blas.*.so -> scipy
    bundled = [
        path
        for folder in (package.parent / "scipy.libs", package / ".dylibs", package / ".libs")
        if folder.is_dir()
        for path in sorted(folder.glob("*openblas*"))
    ]
    # On Linux and macOS a symbol is also found in the libraries that the extension itself is linked to,
    # which covers builds against the system's OpenBLAS. Windows looks in the one file only.
    return bundled if sys.platform == "win32" else [*bundled, extension]
