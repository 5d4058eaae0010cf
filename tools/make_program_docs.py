#!/usr/bin/env python3
"""Writes manual pages (section 1) and completions for bash, zsh and fish of the project's programs.
It reads their tables of options from `PROGRAM --help`, so new options appear at the next build.

make_program_docs.py VERSION FOLDER PROGRAM...

$EMULATOR, words between bars (|), runs programs that were built for another machine.

It writes FOLDER/man/man1/NAME.1, FOLDER/bash-completion/completions/NAME,
FOLDER/zsh/site-functions/_NAME and FOLDER/fish/vendor_completions.d/NAME.fish. The name of an
option's argument determines the completion: FILE, TEXT and similar names complete files, DIR
completes folders, and alternatives in lower case (on|off|auto) complete words.
"""
import os
import pathlib
import re
import subprocess
import sys
from dataclasses import dataclass, field

ABOUT = {
    "vv": "draw VRML97 worlds, in a window or into pictures",
    "openrt-replay": "render a recording of OpenRT calls",
    "openrt-worker": "render parts of pictures for other machines",
    "nodegen": "write code from node specifications"
}


@dataclass
class Option:
    names: list
    argument: str
    text: str = ""

    def words(self):
        parts = self.argument.split("|")
        return [p for p in parts if re.fullmatch(r"[a-z][a-z0-9]*", p)] if len(parts) > 1 else []

    def members(self):
        """For a LIST: returns the words that it may contain, between commas: "... separated by
        commas: a, b, c ..."."""
        found = re.search(r"separated by commas: ((?:[a-z]+, )+[a-z]+)",
                          self.text) if self.argument == "LIST" else None
        return found.group(1).split(", ") if found else []

    def takes(self):
        """Returns the kind of argument: nothing, words, list, file, folder, or not completable."""
        if not self.argument:
            return "nothing"
        if self.words():
            return "words"
        if self.members():
            return "list"
        if self.argument.startswith("DIR"):
            return "folder"
        if re.match(r"FILE|TEXT|PATH|REF\.", self.argument):
            return "file"
        return "other"

    def optional(self):
        return self.argument.startswith("[")

    def brief(self):
        """Returns the first sentence."""
        return re.split(r"(?<=[a-z0-9)])[.;:](?: |$)", self.text)[0].strip().rstrip(".")


@dataclass
class Program:
    name: str
    intro: list = field(default_factory=list)  # lines before the options
    groups: list = field(default_factory=list)  # (title, options)
    footer: list = field(default_factory=list)

    def options(self):
        return [o for _, group in self.groups for o in group]

    def suffixes(self):
        """Returns the suffixes of files it reads: `FILE is .wrl, ...;` in its introduction."""
        found = re.search(r"^FILE is ([^;]*)", "\n".join(self.intro), re.M)
        return re.findall(r"\.[a-z.]+[a-z]", found.group(1)) if found else []


def read_help(name, text):
    program, title = Program(name), None
    for line in text.splitlines():
        option = re.match(r"  (-{1,2}[^\s,]+(?:, ?-{1,2}[^\s,]+)*)(?: (\S.*?))?(?: {2,}(\S.*))?$",
                          line)
        if option:
            argument = re.sub(r" (REQUIRED|Needs|Excludes).*|:.*", "", option[2] or
                              "") if "TEXT" in (option[2] or "") else option[2] or ""
            argument = re.sub(r"^(U?INT|FLOAT)(:.*)?$", "N", argument)
            if not program.groups or program.groups[-1][0] != title:
                program.groups.append((title or "Options", []))
            names = re.split(r", ?", option[1])
            program.groups[-1][1].append(
                Option(names, argument.replace(" ...", ""), option[3] or ""))
        elif re.match(r"\S", line) and not line.startswith("Usage:") and re.fullmatch(
                r"[A-Z][A-Za-z ]*:?", line):
            title = line.rstrip(":")
        elif line.startswith("    ") and program.groups and program.groups[-1][
                0] == title and not program.footer:
            last = program.groups[-1][1][-1]
            last.text = f"{last.text} {line.strip()}".strip()
        elif program.groups and line.strip():
            program.footer.append(line.strip())
        elif not program.groups:
            program.intro.append(line if not line.startswith("Usage:") else "")
    return program


# --- manual page ---


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def manual(program, version):
    name = program.name
    out = [
        f'.TH {name.upper()} 1 "" "OpenRT {version}" "OpenRT Manual"', ".nh", ".ad l", ".SH NAME",
        f"{roff(name)} \\- {roff(ABOUT.get(name, name))}", ".SH SYNOPSIS", f".B {roff(name)}",
        "[\\fIoptions\\fP]", "[\\fIfile\\fP]", ".SH DESCRIPTION"
    ]
    literal = False
    for line in program.intro:
        if re.match(r"(Positionals|Options):?$", line):
            continue
        if line.startswith("  ") != literal:
            literal = not literal
            out.append(".nf" if literal else ".fi")
        out.append(roff(line) if line.strip() else ".PP")
    if literal:
        out.append(".fi")
    out.append(".SH OPTIONS")
    for title, options in program.groups:
        if title != "Options":
            out.append(f".SS {roff(title)}")
        for option in options:
            names = ", ".join(f"\\fB{roff(n)}\\fP" for n in option.names)
            out += [
                ".TP", names + (f" \\fI{roff(option.argument)}\\fP" if option.argument else ""),
                roff(option.text)
            ]
    if program.footer:
        out += [".SH EXIT STATUS", roff(" ".join(program.footer))]
    others = [n for n in sorted(ABOUT) if n != name]
    out += [
        ".SH SEE ALSO", ",\n".join(f".BR {n} (1)" for n in others).replace(",\n", " ,\n") + " ,",
        ".BR openrt (3)"
    ]
    text = "\n".join(out) + "\n"
    text = re.sub(r"(\.PP\n)+(?=\.(SH|SS|PP|nf|fi|TP))", "", text)
    return re.sub(r"(\.SH [^\n]*\n)(\.PP\n)+", r"\1", text)


# --- completions ---


def bash(program):
    function = "_" + program.name.replace("-", "_")
    cases = []
    for option in program.options():
        names = "|".join(option.names)
        action = {
            "words":
                f'mapfile -t COMPREPLY < <(compgen -W "{" ".join(option.words())}" -- "$cur"); return',
            "list":
                f'compopt -o nospace 2>/dev/null; local done=; [[ $cur == *,* ]] && done="${{cur%,*}},"; '
                f'mapfile -t COMPREPLY < <(compgen -P "$done" -W "{" ".join(option.members())}" -- "${{cur##*,}}"); return',
            "file":
                'compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -f -- "$cur"); return',
            "folder":
                'compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- "$cur"); return',
            "other":
                "return",
            "nothing":
                ""
        }[option.takes()]
        if action and not option.optional():
            cases.append(f"    {names}) {action} ;;")
    suffixes = program.suffixes()
    if suffixes:
        files = '{ compgen -d -- "$cur"; ' + " ".join(
            f"compgen -f -X '!*{s}' -- \"$cur\";" for s in suffixes) + " }"
    else:
        files = 'compgen -f -- "$cur"'
    every = " ".join(n for o in program.options() for n in o.names)
    return "\n".join([
        f"# Completion of {program.name} for bash; made from its table of options.",
        f"{function}() {{", '  local cur=${COMP_WORDS[COMP_CWORD]} prev=',
        "  ((COMP_CWORD > 0)) && prev=${COMP_WORDS[COMP_CWORD - 1]}", "  COMPREPLY=()",
        '  case $prev in', *cases, "  esac", '  if [[ $cur == -* ]]; then',
        f'    mapfile -t COMPREPLY < <(compgen -W "{every}" -- "$cur")', "  else",
        "    compopt -o filenames 2>/dev/null", f"    mapfile -t COMPREPLY < <({files})", "  fi",
        "}", f"complete -F {function} {program.name}", ""
    ])


def zsh(program):

    def quoted(text):
        return re.sub(r"([\[\]:\\])", r"\\\1", text).replace("'", "'\\''")

    lines = []
    for option in program.options():
        action = {
            "words": f":{quoted(option.argument)}:({' '.join(option.words())})",
            "list": f":{quoted(option.argument)}:_values -s , word {' '.join(option.members())}",
            "file": f":{quoted(option.argument)}:_files",
            "folder": f":{quoted(option.argument)}:_files -/",
            "other": f":{quoted(option.argument)}:",
            "nothing": ""
        }[option.takes()]
        if option.optional():
            action = ":" + action
        spec = f"[{quoted(option.brief())}]{action}"
        often = "several times" in option.text
        if len(option.names) > 1:
            head = "'*'" if often else f"'({' '.join(option.names)})'"
            lines.append(f"  {head}{{{','.join(option.names)}}}'{spec}'")
        else:
            lines.append(f"  '{'*' if often else ''}{option.names[0]}{spec}'")
    suffixes = program.suffixes()
    pattern = f' -g "*({"|".join(suffixes)})(-.)"' if suffixes else ""
    lines.append(f"  '*:file:_files{pattern}'")
    return (
        f"#compdef {program.name}\n# Completion of {program.name} for zsh; made from its table of options.\n"
        "_arguments -s -S \\\n" + " \\\n".join(lines) + "\n")


def fish(program):

    def quoted(text):
        return text.replace("\\", "\\\\").replace("'", "\\'")

    lines = [f"# Completion of {program.name} for fish; made from its table of options."]
    for option in program.options():
        names = " ".join(
            f"-l {n[2:]}" if n.startswith("--") else f"-s {n[1:]}" for n in option.names)
        action = {
            "words": f" -x -a '{' '.join(option.words())}'",
            "list": f" -x -a '(__fish_append , {' '.join(option.members())})'",
            "file": " -r -F",
            "folder": " -x -a '(__fish_complete_directories)'",
            "other": "" if option.optional() else " -x",
            "nothing": ""
        }[option.takes()]
        lines.append(f"complete -c {program.name} {names}{action} -d '{quoted(option.brief())}'")
    for suffix in program.suffixes():
        lines.append(f"complete -c {program.name} -k -x -a '(__fish_complete_suffix {suffix})'")
    return "\n".join(lines) + "\n"


def main():
    version, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    emulator = [word for word in os.environ.get("EMULATOR", "").split("|") if word]
    for path in map(pathlib.Path, sys.argv[3:]):
        topic = ["all"] if path.name == "vv" else []
        done = subprocess.run([*emulator, path, "--help", *topic],
                              capture_output=True,
                              text=True,
                              timeout=60,
                              check=True)
        program = read_help(path.name, done.stdout)
        if not program.options():
            sys.exit(f"{path.name} --help names no options")
        for place, text in ((f"man/man1/{path.name}.1", manual(program, version)),
                            (f"bash-completion/completions/{path.name}",
                             bash(program)), (f"zsh/site-functions/_{path.name}", zsh(program)),
                            (f"fish/vendor_completions.d/{path.name}.fish", fish(program))):
            file = folder / place
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)


if __name__ == "__main__":
    main()
