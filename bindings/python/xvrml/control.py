"""Controls a world that vv runs, from another process or machine.

>>> from xvrml import control
>>> with control.connect("127.0.0.1:7450") as vv:        # vv world.wrl --control 127.0.0.1:7450
...     vv.set("Door", "translation", (0, 0, 2))
...     vv.subscribe("Bell", "touchTime", lambda value, time: print("rung at", time))
...     png = vv.render(size=(640, 480), samples=64)
...     vv.poll(1)                                       # calls what was subscribed

Nodes are DEF names of the world, or numbers that vv has given out. Values have the shapes of JSON:
numbers, texts, lists; tuples and numpy arrays are accepted, too. docs/control.md describes the
protocol. The module needs only Python's own library (and pyzmq to connect with a key), and its file
works without the rest of the package. A connection belongs to one thread.

Longer than 500 lines because programs may copy the file as it is.
"""
from __future__ import annotations

import base64
import collections
import importlib
import json
import os
import pathlib
import socket
import subprocess
import tempfile
import time as _time
from types import TracebackType
from typing import Any, Callable, Deque, Dict, Iterable, List, NamedTuple, Optional, Sequence, Tuple, Type, Union

Node = Union[str, int]
Callback = Callable[[Any, float], Any]

__all__ = ["Control", "ControlError", "Created", "EditStep", "Made", "connect", "launch"]


class ControlError(Exception):
    """vv refused a command. `code` is a word for programs, the text is for people."""

    def __init__(self, code: str, message: str) -> None:
        super().__init__(message)
        self.code = code


class Created(NamedTuple):
    """Holds what Control.create made: the numbers of the outermost nodes, those of all nodes that
    the text gives a DEF name, and what was wrong with the text."""
    nodes: List[int]
    names: Dict[str, int]
    problems: List[str]


class Made(Dict[str, int]):
    """The node that an edit of a step makes. Within the step, later edits may name it; `number` is
    its number once the step is done."""
    number: int = 0


#: A node, also one that the same step makes; and a place of a node: parent, and perhaps field and
#: index, as Control.parents returns them.
EditedNode = Union[Node, Made]
Place = Dict[str, Any]


class EditStep:
    """Collects the edits of one step (Control.edit). vv does them when the `with` block ends: all
    or, if one is refused, none. An exception within the block does none."""

    def __init__(self, control: Control, name: str) -> None:
        self.name = name
        self._control = control
        self._edits: List[Dict[str, Any]] = []
        self._made: Dict[int, Made] = {}

    def __enter__(self) -> EditStep:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if kind is not None or not self._edits:
            return
        nodes = self._control.call("edit", name=self.name, edits=self._edits)["nodes"]
        for index, made in self._made.items():
            made.number = nodes[index]

    def _add(self, edit: str, **members: Any) -> None:
        self._edits.append({"edit": edit, **members})

    def _add_node(self, edit: str, **members: Any) -> Made:
        made = self._made[len(self._edits)] = Made(edit=len(self._edits))
        self._add(edit, **members)
        return made

    def set(self, node: EditedNode, field: str, value: Any) -> None:
        """Sets a field that holds no nodes."""
        self._add("set", node=node, field=field, value=value)

    def insert(self,
               vrml: str,
               parent: Optional[EditedNode] = None,
               field: str = "children",
               index: Optional[int] = None) -> Made:
        """Inserts one node that is given as text. parent: None for the top of the file. index:
        None for the end."""
        return self._add_node("insert", vrml=vrml, **_target(parent, field, index))

    def use(self,
            node: EditedNode,
            parent: Optional[EditedNode] = None,
            field: str = "children",
            index: Optional[int] = None) -> None:
        """Lets a node stand at a further place (USE)."""
        self._add("use", node=node, **_target(parent, field, index))

    def remove(self, node: EditedNode, at: Optional[Place] = None) -> None:
        """Removes a node. at: which of several places."""
        self._add("remove", node=node, **_at(at))

    def move(self,
             node: EditedNode,
             parent: Optional[EditedNode] = None,
             field: str = "children",
             index: Optional[int] = None,
             at: Optional[Place] = None) -> None:
        """Moves a node. The index is counted without it. at: which of several places."""
        self._add("move", node=node, **_target(parent, field, index), **_at(at))

    def duplicate(self, node: EditedNode, at: Optional[Place] = None) -> Made:
        """Inserts a copy of a node behind it."""
        return self._add_node("duplicate", node=node, **_at(at))

    def wrap(self,
             node: EditedNode,
             type: str = "Transform",
             at: Optional[Place] = None) -> Made:
        """Puts a grouping node around a node."""
        return self._add_node("wrap", node=node, type=type, **_at(at))

    def rename(self, node: EditedNode, name: str) -> None:
        """Gives a node a DEF name, or another one."""
        self._add("rename", node=node, name=name)

    def route(self, source: EditedNode, output: str, target: EditedNode, input: str) -> None:
        """Adds a ROUTE to the file."""
        self._add("route", **{"from": (source, output), "to": (target, input)})

    def unroute(self, source: EditedNode, output: str, target: EditedNode, input: str) -> None:
        """Removes a ROUTE of the file."""
        self._add("unroute", **{"from": (source, output), "to": (target, input)})


def _target(parent: Optional[EditedNode], field: str, index: Optional[int]) -> Dict[str, Any]:
    place: Dict[str, Any] = {"parent": parent, "field": field}
    if index is not None:
        place["index"] = index
    return place


def _at(at: Optional[Place]) -> Dict[str, Any]:
    return {} if at is None else {"at": at}


class _Stream:
    """Lines over a TCP or unix socket."""

    def __init__(self, address: str, timeout: float) -> None:
        if address.startswith("unix:"):
            self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
            self._socket.settimeout(timeout)
            self._socket.connect(address[len("unix:"):])
        else:
            self._socket = socket.create_connection(_host_and_port(address), timeout)
            self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._input = bytearray()
        self._searched = 0

    def send(self, line: bytes, timeout: Optional[float]) -> None:
        self._socket.settimeout(timeout)
        try:
            self._socket.sendall(line + b"\n")
        except (BrokenPipeError, ConnectionResetError):
            pass  # receive() tells why vv has ended the connection

    def receive(self, timeout: Optional[float]) -> Optional[bytes]:
        """Returns a line, or None after `timeout` seconds. Raises ConnectionError at the end."""
        end = None if timeout is None else _time.monotonic() + timeout
        while True:
            at = self._input.find(b"\n", self._searched)
            if at >= 0:
                line = bytes(self._input[:at])
                del self._input[:at + 1]
                self._searched = 0
                return line
            self._searched = len(self._input)
            left = None if end is None else max(end - _time.monotonic(), 0)
            # A timeout of 0 would make the socket non-blocking.
            self._socket.settimeout(None if left is None else max(left, 1e-6))
            try:
                block = self._socket.recv(1 << 16)
            except (socket.timeout, BlockingIOError):
                return None
            if not block:
                raise ConnectionError("vv has ended the connection")
            self._input += block

    def close(self) -> None:
        self._socket.close()


class _Curve:
    """The same, encrypted: each line is a message of ZeroMQ."""

    def __init__(self, address: str, key: Union[str, os.PathLike[str]],
                 server_key: Optional[str]) -> None:
        try:
            self._zmq: Any = importlib.import_module("zmq")
        except ImportError as error:
            raise ImportError(
                "a connection with a key needs the package pyzmq; a tunnel of ssh needs none "
                "(docs/control.md)") from error
        lines = pathlib.Path(key).read_text(encoding="ascii").splitlines()
        words = dict(line.split()[:2] for line in lines if len(line.split()) >= 2)
        if not {"public", "secret"} <= words.keys():
            raise ValueError(f"{key}: this is not a key file, as openrt-worker --new-key makes it")
        self._context: Any = self._zmq.Context()
        self._socket: Any = self._context.socket(self._zmq.DEALER)
        self._socket.linger = 500
        self._socket.heartbeat_ivl = 2000
        self._socket.heartbeat_timeout = 10000
        self._socket.curve_publickey = words["public"].encode()
        self._socket.curve_secretkey = words["secret"].encode()
        self._socket.curve_serverkey = (server_key or words["public"]).encode()
        host, port = _host_and_port(address)
        self._socket.ipv6 = ":" in host
        self._socket.connect(f"tcp://[{host}]:{port}" if ":" in host else f"tcp://{host}:{port}")

    def send(self, line: bytes, timeout: Optional[float]) -> None:
        self._socket.sndtimeo = -1 if timeout is None else int(1000 * timeout)
        try:
            self._socket.send(line)
        except self._zmq.Again:
            raise TimeoutError("vv does not take the command") from None

    def receive(self, timeout: Optional[float]) -> Optional[bytes]:
        end = None if timeout is None else _time.monotonic() + timeout
        while True:
            left = None if end is None else max(0, int(1000 * (end - _time.monotonic())))
            if not self._socket.poll(left):
                return None
            line: bytes = self._socket.recv()
            if line:  # vv sends empty messages to see whether we are there
                return line

    def close(self) -> None:
        self._socket.close()
        self._context.term()


def _host_and_port(address: str) -> Tuple[str, int]:
    host, colon, port = address.rpartition(":")
    if not colon or not port.isdigit():
        raise ValueError(f"HOST:PORT, :PORT or unix:PATH was expected, not {address!r}")
    return host.strip("[]") or "127.0.0.1", int(port)


def _plain(value: Any) -> Any:
    """Converts what json does not know: numpy arrays and their numbers."""
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"a value of JSON was expected, not {type(value).__name__}")


class Control:
    """A connection to vv. Use it in a `with` statement, or call close()."""

    def __init__(self,
                 address: str,
                 *,
                 timeout: float = 10,
                 key: Union[str, os.PathLike[str], None] = None,
                 server_key: Optional[str] = None) -> None:
        """Connects to the address that `vv --control` has printed. timeout: seconds that commands
        wait for their answers; pictures and worlds take the time that they need. key: a key file
        of the cluster, for other machines. server_key: the public key of vv, if its key file is
        another one."""
        self.timeout = timeout
        self._line: Union[_Stream, _Curve] = (_Stream(address, timeout) if key is None else _Curve(
            address, key, server_key))
        self._last = 0
        self._events: Deque[Dict[str, Any]] = collections.deque()
        self._failures: Deque[ControlError] = collections.deque()
        self._callbacks: Dict[Tuple[Node, str], Callback] = {}
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._folder: Optional[tempfile.TemporaryDirectory[str]] = None
        try:
            #: Holds what vv says of itself: program, version, protocol, world.
            self.hello: Dict[str, Any] = self.call("hello")
        except BaseException as error:
            self._line.close()
            if isinstance(error, TimeoutError) and key is not None:
                raise TimeoutError(
                    "vv does not answer; perhaps it does not accept this key") from None
            raise

    def __enter__(self) -> Control:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        self.close()

    def close(self) -> None:
        """Ends the connection, and the program if launch() has started it."""
        if self._process is None:
            self._line.close()
            return
        process, self._process = self._process, None
        try:
            self._send("quit", {})
            process.wait(self.timeout)
        except (OSError, subprocess.TimeoutExpired):
            process.kill()
            process.wait()
        finally:
            self._line.close()
            if self._folder is not None:
                self._folder.cleanup()

    # --- Lines ---

    def call(self, command: str, **members: Any) -> Any:
        """Sends any command and returns its result. Raises ControlError if vv refuses it or has
        refused a quiet one, and TimeoutError."""
        return self._call(command, members, self.timeout)

    def _call(self, command: str, members: Dict[str, Any], wait: Optional[float]) -> Any:
        number = self._send(command, members)
        end = None if wait is None else _time.monotonic() + wait
        while True:
            answer = self._receive(None if end is None else max(0, end - _time.monotonic()))
            if answer is None:
                raise TimeoutError(f"{command}: vv has not answered for {wait} s")
            if answer.get("id") == number:
                break
            self._note(answer)
        if "error" in answer:
            self._failures.append(ControlError(**answer["error"]))
        self._raise()
        return answer["result"]

    def _send(self, command: str, members: Dict[str, Any]) -> int:
        self._last += 1
        line = {"id": self._last, "command": command, **members}
        self._line.send(
            json.dumps(line, default=_plain, allow_nan=False, separators=(",", ":")).encode(),
            self.timeout)
        return self._last

    def _receive(self, timeout: Optional[float]) -> Optional[Dict[str, Any]]:
        try:
            line = self._line.receive(timeout)
        except OSError:
            self._raise()  # the last line said why
            raise
        return None if line is None else json.loads(line)

    def _note(self, answer: Dict[str, Any]) -> None:
        """Keeps an event for poll(), or the error of a quiet command for the next call."""
        if "event" in answer:
            self._events.append(answer)
        elif "error" in answer:
            self._failures.append(ControlError(**answer["error"]))

    def _raise(self) -> None:
        if self._failures:
            raise self._failures.popleft()

    # --- Values ---

    def get(self, node: Node, field: str) -> Any:
        """Returns the value of a field, or the last one that an eventOut has sent."""
        return self.call("get", node=node, field=field)

    def set(self, node: Node, field: str, value: Any, *, quiet: bool = False) -> None:
        """Sends an event to an eventIn or exposedField, or sets a field. quiet: does not wait for
        the answer; the next call or poll raises the error."""
        self._set({"node": node, "field": field, "value": value}, quiet)

    def set_many(self, values: Iterable[Tuple[Node, str, Any]], *, quiet: bool = False) -> None:
        """Sets several fields in one step: all or, if one is refused, none. Their events have one
        time stamp."""
        rows = [{"node": node, "field": field, "value": value} for node, field, value in values]
        if rows:
            self._set({"values": rows}, quiet)

    def _set(self, members: Dict[str, Any], quiet: bool) -> None:
        if quiet:
            self._send("set", {**members, "quiet": True})
        else:
            self.call("set", **members)

    # --- Events ---

    def subscribe(self, node: Node, field: str, callback: Callback) -> Any:
        """Lets poll() call callback(value, time) for each event that an eventOut or exposedField
        sends. time: seconds of the world's time. Returns the present value."""
        value = self.call("subscribe", node=node, field=field)
        self._callbacks[node, field] = callback
        return value

    def unsubscribe(self, node: Node, field: str) -> None:
        """Ends a subscription."""
        self.call("unsubscribe", node=node, field=field)
        self._callbacks.pop((node, field), None)

    def poll(self, seconds: float = 0) -> int:
        """Calls the callbacks of the events that have arrived, and of those that arrive within
        these seconds. Returns their number."""
        end = _time.monotonic() + seconds
        done = 0
        while True:
            while self._events:
                done += self._dispatch(self._events.popleft())
            answer = self._receive(max(0, end - _time.monotonic()))
            if answer is None:
                self._raise()
                return done
            self._note(answer)

    def _dispatch(self, event: Dict[str, Any]) -> int:
        if event["event"] == "world":
            self.hello["world"] = event["world"]
            return 0
        callback = self._callbacks.get((event["node"], event["field"]))
        if callback is None:
            return 0
        if "error" in event:
            raise ControlError(**event["error"])
        callback(event["value"], event["time"])
        return 1

    # --- The scene graph ---

    def create(self, vrml: str) -> Created:
        """Makes nodes from VRML text. They are part of the world at once, but not of its scene: set
        them as children of a group, or call add_root. Their numbers keep them alive until
        release."""
        return Created(**self.call("create", vrml=vrml))

    def add_root(self, node: Node) -> None:
        """Makes a node one of the outermost nodes of the scene."""
        self.call("add_root", node=node)

    def remove_root(self, node: Node) -> None:
        """Takes an outermost node out of the scene."""
        self.call("remove_root", node=node)

    def release(self, *nodes: int) -> None:
        """Gives numbers of nodes back."""
        self.call("release", nodes=nodes)

    def route(self, source: Node, output: str, target: Node, input: str) -> None:
        """Adds a ROUTE from an event out to an event in."""
        self._call("route", {"from": (source, output), "to": (target, input)}, self.timeout)

    def unroute(self, source: Node, output: str, target: Node, input: str) -> None:
        """Removes a ROUTE."""
        self._call("unroute", {"from": (source, output), "to": (target, input)}, self.timeout)

    def node(self, node: Node) -> Dict[str, Any]:
        """Returns the number, the type, the DEF name and the fields of a node."""
        result: Dict[str, Any] = self.call("node", node=node)
        return result

    def names(self) -> Dict[str, str]:
        """Returns the DEF names of the world, with the types of their nodes."""
        result: Dict[str, str] = self.call("names")
        return result

    # --- The file ---

    def edit(self, name: str) -> EditStep:
        """Edits the world's file in one step, which can be undone:

        >>> with vv.edit("Dim the lamp") as step:
        ...     step.set("LAMP", "intensity", 0.5)
        """
        return EditStep(self, name)

    def undo(self) -> Optional[str]:
        """Undoes the last step. Returns its name, None if there is none."""
        name: Optional[str] = self.call("undo")
        return name

    def redo(self) -> Optional[str]:
        """Does the step again that was undone last. Returns its name, None if there is none."""
        name: Optional[str] = self.call("redo")
        return name

    def save(self,
             path: Union[str, os.PathLike[str], None] = None,
             *,
             overwrite: bool = False) -> None:
        """Writes the edited file; with a path, another one. overwrite: also if another program has
        written to the file since it was read."""
        given = {} if path is None else {"path": os.fspath(path)}
        self.call("save", overwrite=overwrite, **given)

    def edits(self, *, text: bool = False) -> Dict[str, Any]:
        """Returns the state of the file: read_only (why, or None), changed, changed_on_disk, the
        names of the steps to undo and redo, recoverable: what an earlier session has left (file,
        time), or None; with text=True also the edited text."""
        result: Dict[str, Any] = self.call("edits", text=text)
        return result

    def recover(self, *, use: bool = True, timeout: Optional[float] = None) -> Optional[str]:
        """Loads the world with the edits that an earlier session has left unsaved, and returns its
        path, as `load` does; with use=False they are thrown away, and None is returned."""
        world: Optional[str] = self._call("recover", {"use": use}, timeout)
        if use:
            self._callbacks.clear()
        return world

    def roots(self) -> List[Dict[str, Any]]:
        """Returns the outermost nodes: node, type, name."""
        result: List[Dict[str, Any]] = self.call("roots")
        return result

    def parents(self, node: Node) -> List[Place]:
        """Returns the places where a node stands: parent, field, index. At the top of the file
        parent and field are None."""
        result: List[Place] = self.call("parents", node=node)
        return result

    def select(self, *nodes: Node) -> None:
        """Selects these nodes, for the window and all clients."""
        self.call("select", nodes=nodes)

    def selection(self) -> List[Dict[str, Any]]:
        """Returns the selected nodes: node, type, name."""
        result: List[Dict[str, Any]] = self.call("selection")
        return result

    def parameters(self, shader_class: str, file: Optional[str] = None) -> List[Dict[str, Any]]:
        """Returns the parameters of a shader class, of which an ORTShader may declare fields: name,
        type of the field, text, default, and minimum and maximum if it has them. file: its plug-in."""
        more = {} if file is None else {"file": file}
        result: List[Dict[str, Any]] = self.call("parameters", **{"class": shader_class}, **more)
        return result

    # --- The viewer, the world, pictures ---

    def pick(self, x: float, y: float) -> Optional[Dict[str, Any]]:
        """Returns what is seen at a place of the picture, which is (-1, -1) at the left and bottom
        and (1, 1) at the right and top: point, normal, facing, distance, path, geometry,
        appearance, shader. None if nothing is there."""
        hit: Optional[Dict[str, Any]] = self._call("pick", {"x": x, "y": y}, None)
        return hit

    def viewpoints(self) -> List[Dict[str, Any]]:
        """Returns the viewpoints: node, name, description, bound."""
        result: List[Dict[str, Any]] = self.call("viewpoints")
        return result

    def probe(self,
              x: float,
              y: float,
              *,
              quantity: str = "luminance",
              samples: Optional[int] = None,
              timeout: Optional[float] = None) -> Dict[str, Any]:
        """Measures the light of a pixel of the true picture. Returns its luminance in cd/m2,
        half_width of the 95 % interval, radiance and radiance_half_width of the three colours,
        samples, trusted: whether the intervals can be trusted, which takes 32 samples or more, and
        hit: what pick returns. samples: of the pixel; None: as many as the window takes.
        With quantity="illuminance" it measures the light that falls on the surface that is seen
        there: illuminance in lux instead of luminance and radiance. samples: of the point; None:
        4,096, or as many as the command line says."""
        given = {} if samples is None else {"samples": samples}
        members = {"x": x, "y": y, "quantity": quantity, **given}
        result: Dict[str, Any] = self._call("probe", members, timeout)
        return result

    def measure(self,
                *,
                samples: Optional[int] = None,
                timeout: Optional[float] = None) -> List[Dict[str, Any]]:
        """Reads all ORTSensors of the world as it is now. Returns them in the order of the file, as
        "sensors" of `vv --measure FILE.json` has them: name, quantity, unit, mean, mean_half_width,
        minimum, maximum, uniformity, points and so on. samples: of each point; None: 4,096, or as
        many as the command line says."""
        given = {} if samples is None else {"samples": samples}
        result: List[Dict[str, Any]] = self._call("measure", given, timeout)
        return result

    def bind(self, viewpoint: Union[str, int]) -> None:
        """Jumps to a viewpoint, named by DEF name, description or number from 0."""
        self.call("bind", viewpoint=viewpoint)

    def key(self, key: str, pressed: Optional[bool] = None) -> bool:
        """Presses a key for the world's KeySensor or StringSensor, and releases it: the character
        that it types, or a name such as "F1", "Up", "Shift" or "Enter". With pressed it is only
        pressed or only released. Returns whether a sensor has taken it."""
        members: Dict[str, Any] = {"key": key}
        if pressed is not None: members["pressed"] = pressed
        taken: bool = self.call("key", **members)
        return taken

    def type(self, text: str) -> bool:
        """Presses and releases the key of each character; a line feed is Enter."""
        taken: bool = self.call("key", text=text)
        return taken

    def load(self, *urls: str, timeout: Optional[float] = None) -> str:
        """Loads another world: the first file that can be read. All numbers of nodes and
        subscriptions end. Returns its path."""
        world: str = self._call("load", {"url": urls}, timeout)
        self._callbacks.clear()
        return world

    def replace_world(self, nodes: Sequence[Node]) -> None:
        """Replaces all nodes of the scene by these."""
        self.call("replace_world", nodes=list(nodes))

    def render(self,
               size: Optional[Tuple[int, int]] = None,
               samples: Optional[int] = None,
               *,
               channels: Optional[Sequence[str]] = None,
               format: Optional[str] = None,
               file: Union[str, os.PathLike[str], None] = None,
               timeout: Optional[float] = None) -> bytes:
        """Renders a picture of the world as it is now, with the bytes of `vv -o`. Returns the bytes
        of the picture file (PNG, or `format`), or, if vv has written `file`, none. An argument that
        is not given is as on vv's command line."""
        given = {
            "size": size,
            "samples": samples,
            "channels": channels,
            "format": format,
            "file": None if file is None else os.fspath(file)
        }
        members = {name: value for name, value in given.items() if value is not None}
        made = self._call("render", members, timeout)
        return base64.b64decode(made.get("data", ""))

    def time(self, *, paused: Optional[bool] = None, skip: Optional[float] = None) -> float:
        """Pauses the world or lets it go on, and lets a paused one run for some seconds. Returns
        its time, in seconds."""
        given = {"paused": paused, "skip": skip}
        members = {name: value for name, value in given.items() if value is not None}
        now: float = self._call("time", members, None)["now"]
        return now

    def quit(self, *, discard: bool = False) -> None:
        """Ends vv. Edits that are not saved are kept for the next session, unless discard is
        true."""
        self.call("quit", discard=discard)


def connect(address: str,
            *,
            timeout: float = 10,
            key: Union[str, os.PathLike[str], None] = None,
            server_key: Optional[str] = None) -> Control:
    """Connects to a vv that runs. See Control."""
    return Control(address, timeout=timeout, key=key, server_key=server_key)


def launch(world: Union[str, os.PathLike[str], None] = None,
           *options: str,
           program: Union[str, os.PathLike[str]] = "vv",
           window: bool = False,
           timeout: float = 60) -> Control:
    """Starts vv with a world and connects to it. options: more options of its command line. window:
    opens a window. timeout: seconds that the start may take. close() ends the program."""
    folder = tempfile.TemporaryDirectory(prefix="vv-control-")
    address = f"unix:{folder.name}/socket"
    process = subprocess.Popen([
        os.fspath(program), *([] if world is None else [os.fspath(world)]), "--control", address,
        *([] if window else ["--no-window"]), *options
    ],
                               stdin=subprocess.DEVNULL)
    end = _time.monotonic() + timeout
    while True:
        try:
            made = Control(address)
            break
        except (FileNotFoundError, ConnectionError) as error:
            code = process.poll()
            if code is None and _time.monotonic() < end:
                _time.sleep(0.01)
                continue
            process.kill()
            process.wait()
            folder.cleanup()
            raise ConnectionError(f"{program} did not start" if code is
                                  None else f"{program} ended with exit code {code}") from error
    made._process, made._folder = process, folder
    return made
