"""A Slurm of one machine for the tests: its own munged, slurmctld and a slurmd for each node, with
everything that they write in one folder. Stopping it ends its jobs and these programs."""
import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import tempfile
import time

PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "squeue", "scancel", "sinfo")

CONFIGURATION = """ClusterName=farm
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={control}
SlurmUser={user}
SlurmdUser={user}
AuthInfo=socket={folder}/munge.socket
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd-%n.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd-%n.log
ProctrackType=proctrack/linuxproc
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
KillWait=2
PartitionName=all Nodes=ALL Default=YES State=UP
"""
NODE = "NodeName={name} NodeHostname={host} NodeAddr=127.0.0.1 Port={port} CPUs={cpus}\n"


def program(name):
    """Returns the path of a program, also of one for administrators, or None."""
    return shutil.which(name, path=os.environ.get("PATH", "") + ":/usr/sbin:/sbin")


def free_ports(count):
    servers = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [server.getsockname()[1] for server in servers]
    for server in servers:
        server.close()
    return ports


class NotStarted(Exception):
    pass


class Slurm:
    """Starts the programs, or raises NotStarted. Each wait may take `patience` seconds."""

    def __init__(self, patience, nodes=("node1", "node2")):
        self.patience = patience
        self.nodes = nodes
        self.running = []
        # Sockets have short names, and munged wants a folder that others may enter.
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="slurm-"))
        self.folder.chmod(0o755)
        try:
            self.start()
        except (OSError, RuntimeError) as problem:
            self.stop()
            raise NotStarted(str(problem)) from problem

    def start(self):
        folder = self.folder
        (folder / "state").mkdir()
        key = folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(128))
        host = socket.gethostname().split(".")[0]
        control, *ports = free_ports(1 + len(self.nodes))
        configuration = folder / "slurm.conf"
        configuration.write_text(
            CONFIGURATION.format(host=host, control=control, user=getpass.getuser(), folder=folder) +
            "".join(
                NODE.format(name=name, host=host, port=port, cpus=os.cpu_count())
                for name, port in zip(self.nodes, ports)))
        self.environment = {**os.environ, "SLURM_CONF": str(configuration)}
        self.spawn("munged", "--foreground", "--force", f"--key-file={key}",
                   f"--socket={folder}/munge.socket", f"--pid-file={folder}/munged.pid",
                   f"--log-file={folder}/munged.log", f"--seed-file={folder}/munge.seed")
        self.wait_for("munged", (folder / "munge.socket").exists)
        self.spawn("slurmctld", "-D")
        for node in self.nodes:
            self.spawn("slurmd", "-D", "-N", node)
        self.wait_for("idle nodes",
                      lambda: self.ask("sinfo", "-h", "-o", "%t %D") == f"idle {len(self.nodes)}")

    def spawn(self, name, *arguments):
        with open(self.folder / f"{name}-{len(self.running)}.out", "wb") as out:
            self.running.append(
                subprocess.Popen([program(name), *arguments],
                                 env=self.environment,
                                 stdin=subprocess.DEVNULL,
                                 stdout=out,
                                 stderr=out,
                                 start_new_session=True))

    def wait_for(self, what, ready):
        end = time.monotonic() + self.patience
        while not ready():
            gone = [each.args[0] for each in self.running if each.poll() is not None]
            if gone or time.monotonic() > end:
                raise RuntimeError(f"no {what}; ended: {gone}\n{self.logs()}")
            time.sleep(.1)

    def logs(self):
        return "\n".join(f"{path.name}: {path.read_text(errors='replace')[-1500:]}"
                         for path in sorted(self.folder.glob("*.out")))

    def ask(self, name, *arguments):
        """Returns what a client program prints, or "" if it has failed."""
        done = subprocess.run([name, *arguments],
                              env=self.environment,
                              capture_output=True,
                              timeout=self.patience)
        return done.stdout.decode().strip() if done.returncode == 0 else ""

    def finish_jobs(self):
        """Waits until no job is queued or running."""
        self.wait_for("end of the jobs", lambda: not self.ask("squeue", "-h"))

    def stop(self):
        if len(self.running) > 2 and all(each.poll() is None for each in self.running):
            self.ask("scancel", "--user", getpass.getuser())
            end = time.monotonic() + self.patience
            while self.ask("squeue", "-h") and time.monotonic() < end:
                time.sleep(.1)
        for each in reversed(self.running):
            each.terminate()
            try:
                each.wait(self.patience)
            except subprocess.TimeoutExpired:
                each.kill()
                each.wait()
        shutil.rmtree(self.folder, ignore_errors=True)
