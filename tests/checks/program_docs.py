#!/usr/bin/env python3
"""Checks the manual pages and completions of the programs. Every option that --help lists is in the
page and in all three completions. The page is valid roff, the completions are valid shell, and bash
completes options, words and worlds.

program_docs.py FOLDER PROGRAM...      FOLDER is <build>/share"""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

folder, complaints, looked = pathlib.Path(sys.argv[1]), [], []


def run(*command, **more):
    return subprocess.run([str(c) for c in command],
                          capture_output=True,
                          text=True,
                          timeout=60,
                          **more)


def completed(script, function, words):
    """Returns bash's completions for the last word."""
    quoted = " ".join(f"'{w}'" for w in words)
    code = f'source "{script}"; COMP_WORDS=({quoted}); COMP_CWORD={len(words) - 1}; {function}; printf "%s\\n" "${{COMPREPLY[@]}}"'
    done = run("bash", "-uc", code, cwd=scratch)
    if done.returncode or done.stderr:
        complaints.append(f"{script.name}: {words}: {done.stderr.strip()}")
    return set(done.stdout.split("\n")) - {""}


with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    for name in ("world one.wrl", "two.wrz", "part.stl", "notes.txt"):
        (scratch / name).touch()
    (scratch / "folder").mkdir()
    for program in map(pathlib.Path, sys.argv[2:]):
        name = program.name
        topic = ["all"] if name == "vv" else []
        listed = re.findall(r"^  (-{1,2}[^\s,]+(?:, ?-{1,2}[^\s,]+)*)",
                            run(program, "--help", *topic).stdout, re.M)
        options = {o for line in listed for o in re.split(r", ?", line)}
        if len(options) < 5:
            complaints.append(f"{name} --help: only {len(options)} options")
        page, bash = folder / f"man/man1/{name}.1", folder / f"bash-completion/completions/{name}"
        zsh, fish = folder / f"zsh/site-functions/_{name}", folder / f"fish/vendor_completions.d/{name}.fish"
        if missing := [f for f in (page, bash, zsh, fish) if not f.exists()]:
            complaints.append(f"not made: {missing}")
            continue
        text = page.read_text()
        for option in sorted(options):
            if "\\fB" + option.replace("-", "\\-") + "\\fP" not in text:
                complaints.append(f"{page.name}: no {option}")
            if not re.search(rf"(^|[\s'{{,(]|\*){re.escape(option)}([\s\[}},)'])", zsh.read_text(),
                             re.M):
                complaints.append(f"{zsh.name}: no {option}")
            spelled = f"-l {option[2:]} " if option.startswith("--") else f"-s {option[1:]} "
            if spelled not in fish.read_text():
                complaints.append(f"{fish.name}: no {option}")
        function = "_" + name.replace("-", "_")
        if wrong := completed(bash, function,
                              [name, "--"]) ^ {o for o in options if o.startswith("--")}:
            complaints.append(f"bash: {name} --: {wrong}")
        if "--help" not in completed(bash, function, [name, "--he"]):
            complaints.append(f"bash: {name} --he is not completed")
        if name == "vv":
            for words, offered in ((["vv", "--headlight",
                                     "o"], {"on",
                                            "off"}), (["vv", "--spp",
                                                       ""], set()), (["vv", "--transport",
                                                                      "w"], {"whitted"}),
                                   (["vv", "--channels",
                                     "nor"], {"normal"}), (["vv", "--channels",
                                                            "z,nor"], {"z,normal"}),
                                   (["vv", "--preset",
                                     ""], {"studio", "product", "technical",
                                           "pcb"}), (["vv", "--preset", "p"], {"product", "pcb"}),
                                   (["vv", ""], {"world one.wrl", "two.wrz", "part.stl",
                                                 "folder"}),
                                   (["vv", "-o", "n"], {"notes.txt"}), (["vv", "--shader-path",
                                                                         ""], set())):
                got = completed(bash, function, words)
                if got != offered and not (words[1] == "--shader-path" and got == {"folder"}):
                    complaints.append(f"bash: {words}: {got}, not {offered}")
        for tool, command in (("groff", ["groff", "-man", "-Tutf8", "-ww", "-z",
                                         page]), ("bash", ["bash", "-n", bash]),
                              ("zsh", ["zsh", "-n", zsh]), ("fish", ["fish", "-n", fish])):
            if not shutil.which(tool):
                print(f"{name}: not looked at by {tool}, which is not installed")
                continue
            done = run(*command)
            if done.returncode or done.stderr.strip():
                complaints.append(f"{tool}: {done.stderr.strip()}")
        looked.append(name)

print(*complaints, f"{', '.join(looked)}: {len(complaints)} complaints", sep="\n")
sys.exit(bool(complaints))
