"""Writes pages about command lines from the programs' own `--help`; called by make_docs.py."""
import re
import subprocess


def escape(text):
    return re.sub(r"([*|\\`])|_(?=\W|$)", lambda m: "\\" + m.group(0), text)


def help_of(program, *topic):
    return subprocess.run([str(program), "--help", *topic],
                          capture_output=True,
                          text=True,
                          timeout=60).stdout


def vv_page(vv):
    """Returns the options of vv by group; each is a target of links and of the search."""
    lines = [
        "vv", "==", "", "*Made from the table of options of the program.*", "", ".. program:: vv",
        "", ".. code-block:: text", ""
    ]
    text = help_of(vv, "all").split("\n")
    first = next(i for i, line in enumerate(text) if re.fullmatch(r"[A-Z]\w+", line))
    lines += ["   " + line if line else "" for line in text[1:first]]
    tail = next(i for i, line in enumerate(text) if line == "Exit codes")
    option, said = None, []

    def flush():
        if option:
            names, _, argument = option.partition(" ")
            while names.endswith(","):
                more, _, argument = argument.partition(" ")
                names += " " + more
            shown = ", ".join(f"{n} {argument}".strip() for n in names.split(", "))
            lines.extend([f".. option:: {shown}", "", "   " + escape(" ".join(said)), ""])

    for line in text[first:tail]:
        if re.fullmatch(r"[A-Z]\w+", line):
            flush()
            option = None
            lines.extend([line, "-" * len(line), ""])
        elif re.match(r"  -", line):
            flush()
            found = re.match(r"  (\S+(?: \S+)*)(?:\s{2,}(\S.*))?$", line)
            option, said = found.group(1), [found.group(2)] if found.group(2) else []
        elif line.strip():
            said.append(line.strip())
    flush()
    lines += ["Exit codes", "----------", ""]
    for line in text[tail + 1:]:
        if code := re.match(r"  (\d+)\s+(.*)", line):
            lines += [f"* {code.group(1)}: {escape(code.group(2))}"]
    lines += [""]
    return "\n".join(lines)


def programs_page(programs):
    """Returns the help of the other programs, as they print it."""
    out = [
        "# Other programs", "", "*What `--help` prints.* `vv` has [a page of its own](vv.rst).", ""
    ]
    for program in programs:
        text = re.sub(r"\S*/(?=" + re.escape(program.name) + r"\b)", "", help_of(program)).strip()
        out += [f"## {program.name}", "", "```text", text, "```", ""]
    return "\n".join(out)
