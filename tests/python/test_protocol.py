"""Tests openrt-worker with a master written only from docs/protocol.md: bare ZeroMQ sockets,
flatbuffers assembled by hand."""
import ctypes
import ctypes.util
import re
import signal
import struct
import subprocess
import threading

import pytest
from conftest import HEADER, ROOT, SMALL, find_vv

zmq = pytest.importorskip("zmq")

WORKER = find_vv().with_name("openrt-worker")
pytestmark = pytest.mark.skipif(not WORKER.exists(), reason="openrt-worker is not built")

hashing = ctypes.CDLL(ctypes.util.find_library("xxhash") or "libxxhash.so.0")
hashing.XXH3_64bits_withSeed.restype = ctypes.c_uint64
hashing.XXH3_64bits_withSeed.argtypes = [ctypes.c_char_p, ctypes.c_size_t, ctypes.c_uint64]


def xxh3(data, seed=0):
    return hashing.XXH3_64bits_withSeed(data, len(data), seed)


def seal(frames, number):
    """Returns the last frame of a message: its number in this direction of the connection, and a
    checksum."""
    total = xxh3(frames[0], number)
    for frame in frames[1:]:
        total = xxh3(struct.pack("<Q", len(frame)), total)
    return struct.pack("<QQ", number, total)


KINDS = [
    "", "Hello", "Need", "Ready", "Failed", "Result", "Log", "Welcome", "Scene", "Piece", "Prepare",
    "Jobs", "Drop", "Beat", "Bye"
]
PATIENCE = 60_000  # milliseconds; machines may be busy


def table(fields):
    """Returns a table whose fields (struct format, value; None: absent) are 8 bytes apart: its
    vtable, then the table. The length is a multiple of 8."""
    size = 4 + 8 * len(fields)
    places = (4 + 8 * i if field else 0 for i, field in enumerate(fields))
    vtable = struct.pack(f"<HH{len(fields)}H", 4 + 2 * len(fields), size, *places)
    # The table starts at 4 modulo 8, so its first field is at 0.
    before = (len(vtable) + 3) // 8 * 8 + 4
    vtable += bytes(before - len(vtable))
    body = struct.pack("<i", before)
    for form, value in (field or ("Q", 0) for field in fields):
        body += struct.pack("<" + form, value).ljust(8, b"\0")
    return vtable + body, before


def header(kind, fields, session=0):
    inner, inner_at = table(fields)
    outer, outer_at = table([("Q", session), ("B", KINDS.index(kind)), ("I", 0)])
    start = 8
    any_field = start + outer_at + 4 + 16
    target = start + len(outer) + inner_at
    data = bytearray(struct.pack("<I4s", start + outer_at, b"ORTW") + outer + inner)
    struct.pack_into("<I", data, any_field, target - any_field)
    return bytes(data)


class Table:

    def __init__(self, data, at):
        self.data, self.at = data, at
        self.vtable = at - struct.unpack_from("<i", data, at)[0]

    def place(self, slot):
        size = struct.unpack_from("<H", self.data, self.vtable)[0]
        offset = struct.unpack_from("<H", self.data, self.vtable + 4 +
                                    2 * slot)[0] if 4 + 2 * slot < size else 0
        return self.at + offset if offset else None

    def get(self, slot, form, default=0):
        place = self.place(slot)
        return default if place is None else struct.unpack_from("<" + form, self.data, place)[0]

    def follow(self, slot):
        place = self.place(slot)
        return None if place is None else place + struct.unpack_from("<I", self.data, place)[0]

    def text(self, slot):
        at = self.follow(slot)
        return "" if at is None else self.data[at + 4:at + 4 +
                                               struct.unpack_from("<I", self.data, at)[0]].decode()

    def count(self, slot):
        at = self.follow(slot)
        return 0 if at is None else struct.unpack_from("<I", self.data, at)[0]


class Master:

    def __init__(self, address):
        self.socket = zmq.Context.instance().socket(zmq.DEALER)
        self.socket.linger = 0
        self.socket.connect("tcp://" + address)
        self.sent = self.received = 0
        self.send("Beat", [("d", 1.0), ("?", False)])

    def send(self, kind, fields, session=0, bulk=()):
        self.send_frames([header(kind, fields, session), *bulk])

    def send_frames(self, frames):
        self.sent += 1
        self.socket.send_multipart([*frames, seal(frames, self.sent)])

    def beat(self):
        self.send("Beat", [("d", 0.5), ("?", True)])

    def receive(self, kind):
        """Returns session and content of the next message of a kind. Answers heartbeats meanwhile,
        so that the worker does not give up."""
        for _ in range(PATIENCE // 50):
            self.beat()
            if not self.socket.poll(50):
                continue
            *frames, last = self.socket.recv_multipart()
            self.received += 1
            assert last == seal(frames, self.received)
            data = self.last = frames[0]
            assert data[4:8] == b"ORTW"
            root = Table(data, struct.unpack_from("<I", data)[0])
            name, content = KINDS[root.get(1, "B")], Table(data, root.follow(2))
            if name == kind and (kind != "Beat" or content.get(1, "?", False)):
                return root.get(0, "Q"), content
        raise AssertionError(f"no {kind} has come")

    def welcome(self, session=42, protocol=4):
        self.receive("Hello")
        # A busy machine must not count as lost, so long silences are allowed.
        self.send("Welcome", [("I", protocol), ("Q", session), ("f", 0.1), ("f", 60.0)], session)
        return session

    def scene(self, epoch, edits, session=42):
        # The vectors of arrays and libraries would be fields 3 and 4. Absent ones are 0 in the
        # vtable.
        self.send("Scene", [("Q", epoch), ("?", True), ("?", True), None, None, ("Q", xxh3(edits))],
                  session, [edits])

    def close(self):
        self.socket.close()


class Worker:

    def __init__(self, *options):
        self.process = subprocess.Popen(
            [WORKER, "--listen", "127.0.0.1:0", "--threads", "1", *options],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True)
        line = self.process.stdout.readline()
        assert line.startswith("listening at "), line
        self.address = line.split()[2]

    def end(self, how=signal.SIGTERM):
        self.process.send_signal(how)
        try:
            _, said = self.process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            self.process.kill()
            raise
        return self.process.returncode, said


@pytest.fixture()
def worker():
    w = Worker()
    yield w
    if w.process.poll() is None:
        assert w.end()[0] == 0


def test_a_caller_that_beats_is_told_hello(worker):
    session, hello = Master(worker.address).receive("Hello")
    assert session == 0
    assert hello.get(0, "I") == 4
    assert hello.get(7, "I") == 1
    assert hello.get(9, "I") == worker.process.pid
    assert hello.text(4) in ("avx512", "avx2", "sse")
    assert hello.text(5).startswith("Embree")
    assert all(hello.text(slot) for slot in (1, 6, 8))


def test_the_names_of_all_statistics_are_documented():
    table = (ROOT / "libopenrt/backend/cluster/messages/statistics.h").read_text()
    names = re.findall(r'^  f\("([\w.]+)", s\.([\w.]+)\);$', table, re.M)
    assert len(names) > 40
    assert all(name == member for name, member in names)
    page = (ROOT / "docs/protocol.md").read_text()
    assert [name for name, _ in names if f"`{name}`" not in page] == []


def test_beats_come_back(worker):
    master = Master(worker.address)
    master.welcome()
    master.send("Beat", [("d", 123.25), ("?", False)])
    while True:
        _, beat = master.receive("Beat")
        if beat.get(0, "d") == 123.25:
            break


def test_another_protocol_is_refused_with_both_numbers(worker):
    master = Master(worker.address)
    master.welcome(protocol=7)
    _, bye = master.receive("Bye")
    assert "7" in bye.text(0) and "4" in bye.text(0)


def test_one_master_at_a_time(worker):
    first = Master(worker.address)
    first.welcome()
    second = Master(worker.address)
    _, bye = second.receive("Bye")
    assert "busy" in bye.text(0)


def test_junk_ends_the_connection_and_the_next_master_is_served(worker):
    master = Master(worker.address)
    master.welcome()
    for junk in (b"", b"junk", bytes(1000)):
        master.send_frames([junk])
    _, bye = master.receive("Bye")
    assert "three invalid messages" in bye.text(0)
    Master(worker.address).welcome()


def test_scenes_are_answered_and_edits_that_are_none_refused(worker):
    master = Master(worker.address)
    session = master.welcome()
    master.scene(5, b"no edits at all")
    got, need = master.receive("Need")
    assert (got, need.get(0, "Q"), need.count(1)) == (session, 5, 0)
    _, failed = master.receive("Failed")
    assert failed.get(0, "Q") == 5
    assert "flatbuffer" in failed.text(1)


def test_a_master_does_not_wait_for_ever_for_a_worker_that_never_gets_ready(worker, vv):
    real = Master(worker.address)
    real.receive("Hello")
    listener = zmq.Context.instance().socket(zmq.ROUTER)
    port = listener.bind_to_random_port("tcp://127.0.0.1")
    over, heard = threading.Event(), []

    # A worker that announces itself like a real one, sends heartbeats, and does nothing.
    def serve():
        numbers = {}
        while not over.is_set():
            if listener.poll(50):
                route, *frames = listener.recv_multipart()
                heard.append(frames[0])
                if route not in numbers:
                    numbers[route] = 1
                    listener.send_multipart([route, real.last, seal([real.last], 1)])
            for route in numbers:
                numbers[route] += 1
                frames = [header("Beat", [("d", 0.5), ("?", True)])]
                listener.send_multipart([route, *frames, seal(frames, numbers[route])])

    thread = threading.Thread(target=serve)
    thread.start()
    try:
        vv.write("ball.wrl", HEADER + "Shape { geometry Sphere { } }")
        said = vv("ball.wrl", "-o", "ball.png", *SMALL, "--local-threads", 0, "--workers",
                  f"127.0.0.1:{port}")
    finally:
        over.set()
        thread.join()
        listener.close(0)
    assert said.returncode == 0, said.stderr
    assert "this process helps" in said.stderr.decode()
    assert len(heard) > 50  # it was connected all the time


def test_messages_of_another_session_are_not_heard(worker):
    master = Master(worker.address)
    session = master.welcome()
    master.scene(5, b"x", session + 1)
    master.scene(6, b"x", session)
    _, need = master.receive("Need")
    assert need.get(0, "Q") == 6


def test_signals_end_it():
    assert Worker().end(signal.SIGTERM)[0] == 0
    assert Worker().end(signal.SIGINT)[0] == 130


def test_the_end_is_said():
    worker = Worker()
    master = Master(worker.address)
    master.welcome()
    worker.end()
    master.receive("Bye")


def test_once_ends_with_its_master():
    worker = Worker("--once")
    master = Master(worker.address)
    master.welcome()
    master.scene(5, b"x")
    master.receive("Need")
    master.close()
    assert worker.process.wait(timeout=60) == 0
    worker.process.communicate()


def run(*options):
    done = subprocess.run([WORKER, *options], capture_output=True, text=True, timeout=60)
    return done.returncode, done.stdout, done.stderr


def test_other_addresses_need_keys_and_the_remedy_is_said():
    code, _, said = run("--listen", "0.0.0.0:0")
    assert code == 2
    assert "--new-key" in said and "--key" in said


def test_new_keys(tmp_path):
    code, key, _ = run("--new-key", str(tmp_path / "key"))
    assert code == 0 and len(key.strip()) == 40
    assert (tmp_path / "key").stat().st_mode & 0o777 == 0o600
    assert run("--new-key", str(tmp_path / "key"))[0] == 3
    (tmp_path / "key").chmod(0o644)
    code, _, said = run("--listen", "127.0.0.1:0", "--key", str(tmp_path / "key"))
    assert code == 3 and "chmod 600" in said
    assert run("--listen", "127.0.0.1:0", "--key", str(tmp_path / "absent"))[0] == 3


def test_options_that_are_none():
    assert run("--no-such-option")[0] == 2
    assert run("--listen", "a:b")[0] == 2
    assert run("--connect", "127.0.0.1:1", "--listen", "127.0.0.1:0")[0] == 2
    assert run("--allow", "x")[0] == 2
    assert run("--version")[0] == 0
