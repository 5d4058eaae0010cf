"""Defines what vv promises for each class of file in the corpus. Used by corpus.py."""
import re

PLACE = re.compile(r":\d+:\d+: (error|warning): ")


def broken(kind, code, log, timeout):
    """Returns, in words, the promises that a run of vv with this exit code and these messages
    breaks."""
    if code is None:
        return [f"still running after {timeout} s"]
    if code < 0 or code >= 128:
        return [f"ended by signal {-code if code < 0 else code - 128}"]
    if "Sanitizer" in log or "runtime error:" in log:
        return ["sanitizer report"]
    if kind == "strict":
        return [f"exit code {code}, not 0"] if code else []
    if kind == "bad":
        return [] if code == 3 or ": error: " in log and PLACE.search(log) else [
            f"exit code {code} and no error with line and column"
        ]
    if kind in ("ext", "header"):
        wrong = [f"exit code {code}, not 0"] if code else []
        return wrong if PLACE.search(log) else wrong + ["no message with line and column"]
    if kind == "v1":
        return [f"exit code {code}, not 0"] if code else []
    return [f"unknown class {kind}"]
