"""A file manager's part in dragging a file onto a window: the XDND protocol, spoken with libX11 as it is installed.

A process of its own, because libX11 ends one on errors:
``python -m tests.gui.drag_source DISPLAY X Y FILE`` drops FILE, a path as the window's program sees it, at a place
of the screen, and ends with 0 when the window has taken it.
"""

from __future__ import annotations

import ctypes
import ctypes.util
import sys
import time
from ctypes import POINTER, Structure, Union, byref, c_char_p, c_int, c_long, c_ubyte, c_uint, c_ulong, c_void_p
from urllib.parse import quote

#: Seconds until the window has to answer.
PATIENCE = 20.0
#: X's numbers of what happens, of a property that replaces another one, and of "whatever type it has".
SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE, REPLACE, ANY_TYPE = 30, 31, 33, 0, 0


class _ClientMessage(Structure):
    _fields_ = (
        *(("type", c_int), ("serial", c_ulong), ("sent", c_int), ("display", c_void_p), ("window", c_ulong)),
        *(("message", c_ulong), ("format", c_int), ("data", c_long * 5)),
    )


class _SelectionRequest(Structure):
    _fields_ = (
        *(("type", c_int), ("serial", c_ulong), ("sent", c_int), ("display", c_void_p), ("owner", c_ulong)),
        *(("requestor", c_ulong), ("selection", c_ulong), ("target", c_ulong), ("property", c_ulong)),
        ("time", c_ulong),
    )


class _Selection(Structure):
    _fields_ = (
        *(("type", c_int), ("serial", c_ulong), ("sent", c_int), ("display", c_void_p), ("requestor", c_ulong)),
        *(("selection", c_ulong), ("target", c_ulong), ("property", c_ulong), ("time", c_ulong)),
    )


class _Event(Union):
    _fields_ = (
        *(("type", c_int), ("client", _ClientMessage), ("request", _SelectionRequest), ("selection", _Selection)),
        ("space", c_long * 24),
    )


#: What the functions of libX11 take, without the display that comes first, and what they give back.
_FUNCTIONS = {
    "XDefaultRootWindow": ((), c_ulong),
    "XInternAtom": ((c_char_p, c_int), c_ulong),
    "XCreateSimpleWindow": ((c_ulong, c_int, c_int, c_uint, c_uint, c_uint, c_ulong, c_ulong), c_ulong),
    "XQueryTree": (
        (c_ulong, POINTER(c_ulong), POINTER(c_ulong), POINTER(POINTER(c_ulong)), POINTER(c_uint)),
        c_int,
    ),
    "XGetWindowProperty": (
        (
            *(c_ulong, c_ulong, c_long, c_long, c_int, c_ulong, POINTER(c_ulong), POINTER(c_int)),
            *(POINTER(c_ulong), POINTER(c_ulong), POINTER(POINTER(c_ulong))),
        ),
        c_int,
    ),
    "XChangeProperty": ((c_ulong, c_ulong, c_ulong, c_int, c_int, POINTER(c_ubyte), c_int), c_int),
    "XSetSelectionOwner": ((c_ulong, c_ulong, c_ulong), c_int),
    "XSendEvent": ((c_ulong, c_int, c_long, POINTER(_Event)), c_int),
    "XPending": ((), c_int),
    "XNextEvent": ((POINTER(_Event),), c_int),
    "XFlush": ((), c_int),
}


class DragSource:
    def __init__(self, display: str) -> None:
        self._library = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
        self._library.XOpenDisplay.restype = c_void_p
        self._display = c_void_p(self._library.XOpenDisplay(display.encode()))
        if not self._display:
            raise SystemExit(f"there is no display {display}")
        for name, (takes, gives) in _FUNCTIONS.items():
            function = getattr(self._library, name)
            function.argtypes, function.restype = (c_void_p, *takes), gives
        root = self._call("XDefaultRootWindow")
        self._window = self._call("XCreateSimpleWindow", root, 0, 0, 1, 1, 0, 0, 0)
        self._target, self._version = self._aware(root)

    def _call(self, name: str, *arguments: object) -> int:
        return getattr(self._library, name)(self._display, *arguments)

    def _atom(self, name: str) -> int:
        return self._call("XInternAtom", name.encode(), 0)

    def _aware(self, root: int) -> tuple[int, int]:
        """The window that files can be dropped on, and the version of the protocol that it knows."""
        parents = (c_ulong(), c_ulong())
        children, count = POINTER(c_ulong)(), c_uint()
        self._call("XQueryTree", root, byref(parents[0]), byref(parents[1]), byref(children), byref(count))
        for k in range(count.value):
            kind, width, length, left = c_ulong(), c_int(), c_ulong(), c_ulong()
            values = POINTER(c_ulong)()
            found = (byref(kind), byref(width), byref(length), byref(left), byref(values))
            self._call("XGetWindowProperty", children[k], self._atom("XdndAware"), 0, 1, 0, ANY_TYPE, *found)
            if length.value:
                return children[k], values[0]
        raise SystemExit("no window takes files")

    def _send(self, window: int, event: _Event) -> None:
        self._call("XSendEvent", window, 0, 0, byref(event))
        self._call("XFlush")

    def _tell(self, message: str, *data: int) -> None:
        event = _Event()
        event.client.type, event.client.window, event.client.format = CLIENT_MESSAGE, self._target, 32
        event.client.message = self._atom(message)
        event.client.data[:] = [self._window, *data, *[0] * (4 - len(data))]
        self._send(self._target, event)

    def _hear(self, message: str, data: bytes) -> list[int]:
        """Waits for a message of the target's, and meanwhile gives it the data when it asks."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if not self._call("XPending"):
                time.sleep(0.01)
                continue
            event = _Event()
            self._call("XNextEvent", byref(event))
            if event.type == SELECTION_REQUEST:
                self._give(event.request, data)
            elif event.type == CLIENT_MESSAGE and event.client.message == self._atom(message):
                return list(event.client.data)
        raise SystemExit(f"the window does not answer with {message}")

    def _give(self, request: _SelectionRequest, data: bytes) -> None:
        buffer = (c_ubyte * len(data)).from_buffer_copy(data)
        self._call(
            "XChangeProperty", request.requestor, request.property, request.target, 8, REPLACE, buffer, len(data)
        )
        event = _Event()
        answer = event.selection
        answer.type, answer.requestor, answer.time = SELECTION_NOTIFY, request.requestor, request.time
        answer.selection, answer.target, answer.property = request.selection, request.target, request.property
        self._send(request.requestor, event)

    def drop(self, place: tuple[int, int], file: str) -> bool:
        """Whether the window has taken it."""
        data = f"file://{quote(file)}\r\n".encode()
        self._call("XSetSelectionOwner", self._atom("XdndSelection"), self._window, 0)
        self._tell("XdndEnter", self._version << 24, self._atom("text/uri-list"))
        self._tell("XdndPosition", 0, place[0] << 16 | place[1], 0, self._atom("XdndActionCopy"))
        if not self._hear("XdndStatus", data)[1] & 1:
            return False
        self._tell("XdndDrop", 0, 0)
        self._hear("XdndFinished", data)
        return True


if __name__ == "__main__":
    screen, x, y, path = sys.argv[1:]
    raise SystemExit(0 if DragSource(screen).drop((int(x), int(y)), path) else 1)
