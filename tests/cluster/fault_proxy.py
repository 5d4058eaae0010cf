"""A TCP proxy between a master and a worker that injects faults. While it runs, each link can be
slowed down, delayed, cut, or have its bytes changed; faults are counted. It uses threads of its
own; close() ends them."""
import collections
import random
import socket
import struct
import threading
import time

CHUNK = 1 << 16


class FaultProxy:
    """Listens on a free port of loopback and forwards to target, a (host, port).

    delay        seconds by which every byte is delayed
    bandwidth    bytes per second in each direction; 0: no limit
    loss         probability that a chunk is lost; as with TCP's retransmission, it and all later
                 chunks arrive `repair` seconds later"""

    def __init__(self, target, seed=1):
        self.target = target
        self.delay = 0.0
        self.bandwidth = 0
        self.loss = 0.0
        self.repair = 0.2
        self.passed = 0
        self.connections = 0
        self._random = random.Random(seed)
        self._flowing = threading.Event()
        self._flowing.set()
        self._flip = 0
        self._swallow = 0
        self._twice = 0
        self._open = True
        self._links = set()
        self._lock = threading.Lock()
        self._socket = socket.create_server(("127.0.0.1", 0))
        self.port = self._socket.getsockname()[1]
        self.address = f"127.0.0.1:{self.port}"
        threading.Thread(target=self._accept, daemon=True).start()

    # Faults --------------------------------------------------------------------------------------

    def partition(self):
        """Stops all forwarding without loss, as when a switch goes down."""
        self._flowing.clear()

    def heal(self):
        self._flowing.set()

    def cut(self):
        """Resets all connections. New ones are accepted."""
        with self._lock:
            links = list(self._links)
        for pair in links:
            for end in pair:
                try:
                    end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                    # Wakes its reader, for which close() would wait otherwise.
                    end.shutdown(socket.SHUT_RD)
                    end.close()
                except OSError:
                    pass

    def corrupt(self, chunks=1):
        """Changes a byte in each of the next chunks."""
        self._flip += chunks

    def swallow(self, chunks=1):
        """Drops the next chunks, so that the following bytes are out of step."""
        self._swallow += chunks

    def repeat(self, chunks=1):
        """Sends the next chunks twice."""
        self._twice += chunks

    def close(self):
        self._open = False
        self._flowing.set()
        self._socket.close()
        self.cut()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    # ------------------------------------------------------------------------------------------------------------------

    def _accept(self):
        while self._open:
            try:
                near, _ = self._socket.accept()
            except OSError:
                return
            try:
                far = socket.create_connection(self.target, timeout=5)
                far.settimeout(None)
            except OSError:
                near.close()
                continue
            self.connections += 1
            for end in (near, far):
                end.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            with self._lock:
                self._links.add((near, far))
            for source, sink in ((near, far), (far, near)):
                threading.Thread(target=self._pump, args=(source, sink, (near, far)),
                                 daemon=True).start()

    def _pump(self, source, sink, pair):
        queue = collections.deque()
        arrived = threading.Condition()
        threading.Thread(target=self._deliver, args=(queue, arrived, sink), daemon=True).start()
        free = last = 0.0
        try:
            while True:
                with arrived:
                    while len(queue) > 256:  # flow control: the sender has to wait
                        arrived.wait(1)
                data = source.recv(CHUNK)
                if not data:
                    break
                data = self._damage(data)
                if not data:
                    continue
                due = time.monotonic() + self.delay
                if self.loss and self._random.random() < self.loss:
                    due += self.repair
                if self.bandwidth:
                    free = max(free, time.monotonic()) + len(data) / self.bandwidth
                    due = max(due, free + self.delay)
                last = due = max(due, last)  # in order
                with arrived:
                    queue.append((due, data))
                    arrived.notify()
        except OSError:
            pass
        with arrived:
            queue.append((last, None))
            arrived.notify()
        with self._lock:
            self._links.discard(pair)

    def _damage(self, data):
        if self._swallow:
            self._swallow -= 1
            return b""
        if self._flip:
            self._flip -= 1
            at = self._random.randrange(len(data))
            data = data[:at] + bytes([data[at] ^ (1 << self._random.randrange(8))]) + data[at + 1:]
        if self._twice:
            self._twice -= 1
            data += data
        return data

    def _deliver(self, queue, arrived, sink):
        while True:
            with arrived:
                while not queue:
                    arrived.wait()
                due, data = queue.popleft()
                arrived.notify()
            while (wait := due - time.monotonic()) > 0:
                time.sleep(wait)
            self._flowing.wait()
            try:
                if data is None:
                    sink.shutdown(socket.SHUT_WR)
                    return
                sink.sendall(data)
                self.passed += len(data)
            except OSError:
                return
