"""Drops a file on a window of an X server, as file managers do (the XDND protocol), with libX11."""
import ctypes
import ctypes.util
import pathlib

import pytest

CLIENT_MESSAGE, SELECTION_REQUEST, SELECTION_NOTIFY = 33, 30, 31
MOST_EVENTS = 1000

Long, Word = ctypes.c_long, ctypes.c_ulong  # XIDs, atoms and times are words


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", Word), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("window", Word), ("message_type", Word),
                ("format", ctypes.c_int), ("data", Long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", Word), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("owner", Word), ("requestor", Word),
                ("selection", Word), ("target", Word), ("property", Word), ("time", Word)]


class SelectionNotify(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", Word), ("send_event", ctypes.c_int),
                ("display", ctypes.c_void_p), ("requestor", Word), ("selection", Word),
                ("target", Word), ("property", Word), ("time", Word)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("message", ClientMessage), ("request", SelectionRequest),
                ("pad", Long * 24)]


class Source:
    """A program that files are dragged from."""

    def __init__(self, display):
        name = ctypes.util.find_library("X11")
        if not name:
            pytest.skip("libX11 is not installed")
        self.x = ctypes.CDLL(name)
        for function, result, *arguments in (
            ("XOpenDisplay", ctypes.c_void_p, ctypes.c_char_p),
            ("XDefaultRootWindow", Word, ctypes.c_void_p),
            ("XCreateSimpleWindow", Word, ctypes.c_void_p, Word, *[ctypes.c_int] * 2,
             *[ctypes.c_uint] * 3, Word, Word),
            ("XInternAtom", Word, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_int),
            ("XSetSelectionOwner", ctypes.c_int, ctypes.c_void_p, Word, Word, Word),
            ("XSendEvent", ctypes.c_int, ctypes.c_void_p, Word, ctypes.c_int, Long, ctypes.c_void_p),
            ("XChangeProperty", ctypes.c_int, ctypes.c_void_p, Word, Word, Word, ctypes.c_int,
             ctypes.c_int, ctypes.c_char_p, ctypes.c_int),
            ("XNextEvent", ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p),
            ("XFlush", ctypes.c_int, ctypes.c_void_p),
            ("XCloseDisplay", ctypes.c_int, ctypes.c_void_p)):
            one = getattr(self.x, function)
            one.restype, one.argtypes = result, arguments
        self.display = self.x.XOpenDisplay(display.encode())
        root = self.x.XDefaultRootWindow(self.display)
        self.window = self.x.XCreateSimpleWindow(self.display, root, 0, 0, 1, 1, 0, 0, 0)

    def atom(self, name):
        return self.x.XInternAtom(self.display, name.encode(), 0)

    def send(self, target, message, *data):
        event = Event()
        event.message.type, event.message.format = CLIENT_MESSAGE, 32
        event.message.window, event.message.message_type = target, self.atom(message)
        event.message.data[:] = [self.window, *data, *[0] * (4 - len(data))]
        self.x.XSendEvent(self.display, target, 0, 0, ctypes.byref(event))
        self.x.XFlush(self.display)

    def wait(self, what):
        """Returns the next event of this type or message."""
        for _ in range(MOST_EVENTS):
            event = Event()
            self.x.XNextEvent(self.display, ctypes.byref(event))
            if event.type == what or (event.type == CLIENT_MESSAGE and
                                      event.message.message_type == what):
                return event
        raise AssertionError("no answer to the drop")

    def answer(self, request, text):
        self.x.XChangeProperty(self.display, request.requestor, request.property, request.target, 8,
                               0, text, len(text))
        event, told = Event(), SelectionNotify()
        told.type, told.requestor, told.selection = SELECTION_NOTIFY, request.requestor, request.selection
        told.target, told.property, told.time = request.target, request.property, request.time
        ctypes.memmove(ctypes.byref(event), ctypes.byref(told), ctypes.sizeof(told))
        self.x.XSendEvent(self.display, request.requestor, 0, 0, ctypes.byref(event))
        self.x.XFlush(self.display)

    def drop(self, target, file):
        uris, version = self.atom("text/uri-list"), 5
        self.x.XSetSelectionOwner(self.display, self.atom("XdndSelection"), self.window, 0)
        self.send(target, "XdndEnter", version << 24, uris)
        self.send(target, "XdndPosition", 0, 100 << 16 | 100, 0, self.atom("XdndActionCopy"))
        self.wait(self.atom("XdndStatus"))
        self.send(target, "XdndDrop", 0, 0)
        uri = pathlib.Path(file).resolve().as_uri() + "\r\n"
        self.answer(self.wait(SELECTION_REQUEST).request, uri.encode())
        self.wait(self.atom("XdndFinished"))


def drop(display, window, file):
    """window: the number of the window."""
    source = Source(display)
    try:
        source.drop(int(window), file)
    finally:
        source.x.XCloseDisplay(source.display)
