#!/usr/bin/env python3
"""Keeps calls that only some systems have in one folder, common/system: portable.py ROOT

The libraries, programs and plug-ins otherwise call what POSIX and C++ have, so that macOS needs a look
at that folder alone. Comments and texts are not read.

portable.py ROOT       checks the tree
portable.py --self     tests the check with lines that must be refused and some that must pass"""
import pathlib
import re
import sys

PLACE = "common/system/"
TREES = ("libopenrt", "libxvrml", "libpicture", "apps", "bindings", "common", "plugins")
HEADERS = re.compile(
    r"^\s*#\s*include\s*<((?:linux|gnu|asm|bits|mach|mach-o)/[^>]*|sys/(?:epoll|eventfd|signalfd|timerfd|inotify|prctl|syscall|sysinfo|sendfile|random|personality|ucred)\.h"
    r"|link\.h|malloc\.h|malloc/malloc\.h|sched\.h|features\.h|execinfo\.h|crt_externs\.h|libproc\.h|seccomp\.h)>",
    re.M)
CALLS = re.compile(
    r"\b(prctl|syscall|prlimit(?:64)?|epoll_\w+|eventfd|signalfd|timerfd_\w+|inotify_\w+|memfd_create|pidfd_\w+"
    r"|accept4|pipe2|dup3|ppoll|unshare|setns|clone|renameat2|copy_file_range|sendfile|fallocate|sync_file_range"
    r"|sched_[gs]etaffinity|gettid|getrandom|secure_getenv|clearenv|execvpe|mremap|malloc_\w+|mallinfo2?"
    r"|dlinfo|dladdr1|dlmopen|dl_iterate_phdr|get_nprocs\w*|sysinfo|backtrace\w*|fopencookie|qsort_r|getpeereid|issetugid"
    r"|sigdescr_np|sigabbrev_np|pthread_\w+_np|posix_spawn\w+_np|clock_getcpuclockid|gnu_get_libc_version)\s*\("
    r"|\b(MSG_NOSIGNAL|MSG_CMSG_CLOEXEC|SOCK_CLOEXEC|SOCK_NONBLOCK|SO_PEERCRED|SO_NOSIGPIPE|TCP_INFO|O_TMPFILE|O_PATH"
    r"|CLOCK_\w+_COARSE|CLOCK_BOOTTIME|RTLD_DEEPBIND|RTLD_DI_\w+|MAP_POPULATE|PR_[SG]ET_\w+|SCMP_\w+|RLIMIT_AS_NP)\b"
    r"|\b(ucred|tcp_info|link_map|cpu_set_t|__rlimit_resource)\b|\bst_[amc]tim(?:espec)?\b")
# Files of the kernel. Those of control groups are missing elsewhere, and then no limit is known.
FILES = re.compile(r'"(/proc/(?!self/cgroup)|/dev/(?!null\b|stdin\b|stdout\b|tty\b)|/sys/(?!fs/cgroup))')
# These stay elsewhere, for these reasons.
EXCEPT = {
    "libxvrml/tools/cage/cage.cpp": "the filter of system calls, built where libseccomp is",
    "libopenrt/backend/cluster/net/greeting.cpp": "asks glibc for its version, if it is glibc",
}
NOISE = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])\'',
                   re.S)


def bare(text, strings):
    """Returns the text with comments, and unless `strings` also texts, blanked; lines stay."""

    def blank(match):
        word = match.group()
        if strings and not word.startswith("/"):
            return word
        return re.sub(r"[^\n]", " ", word)

    return NOISE.sub(blank, text)


def check(path, text):
    if path.startswith(PLACE) or path in EXCEPT:
        return
    code = bare(text, False)
    found = [(m.start(), m.group().strip()) for m in HEADERS.finditer(code)]
    found += [(m.start(), m.group()) for m in CALLS.finditer(code)]
    found += [(m.start(), m.group(1)) for m in FILES.finditer(bare(text, True))]
    for at, what in sorted(found):
        line = text.count("\n", 0, at) + 1
        yield f"{path}:{line}: {what} is not in every system: call it in {PLACE}"


def self_test():
    refused = [
        "#include <sys/eventfd.h>", "#include <linux/tcp.h>", "int fd = eventfd(0, 0);",
        "send(fd, a, b, MSG_NOSIGNAL);", 'fopen("/proc/self/statm", "r");', "return s.st_mtim;",
        "::accept4(fd, nullptr, nullptr, 0);", 'x = "a"; prctl(1); // "', "ucred who{};"
    ]
    passing = [
        "// eventfd(0, 0)", '"prctl(1)";', "#include <sys/socket.h>", "poll(&ready, 1, 0);",
        'open("/dev/null", 0);', 'file("/proc/self/cgroup");', "return s.st_mtime;",
        "/* SO_PEERCRED */ int a = '\"'; // st_mtim", "ages.splice(ages.end(), ages, one);"
    ]
    wrong = [f"accepted: {line}" for line in refused if not list(check("apps/a.cpp", line))]
    wrong += [f"refused: {line}" for line in passing if list(check("apps/a.cpp", line))]
    if list(check(PLACE + "a.h", refused[0])):
        wrong.append("refused in its own folder")
    return wrong


def main():
    if sys.argv[1:] == ["--self"]:
        complaints, files = self_test(), []
    else:
        root = pathlib.Path(sys.argv[1]).resolve()
        files = [
            path for tree in TREES for path in sorted((root / tree).rglob("*"))
            if path.suffix in {".c", ".cpp", ".h", ".hpp"}
        ]
        complaints = [
            c for path in files for c in check(path.relative_to(root).as_posix(),
                                               path.read_text(encoding="utf-8"))
        ]
        for path in EXCEPT:
            if not (root / path).is_file():
                complaints.append(f"{path} is gone: take it out of tests/checks/portable.py")
        if len(files) < 100:
            complaints.append(f"only {len(files)} files: is this the root?")
    print(*complaints, f"{len(files)} files, {len(complaints)} complaints", sep="\n")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
