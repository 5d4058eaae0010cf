"""Writes the Python reference: signatures from the stubs, docstrings from the stubs or from the
running package; called by make_docs.py."""
import ast
import importlib
import inspect
import re


def escape(text):
    return re.sub(r"([*|\\])", r"\\\1", text)


def signature(function, skip_self):
    text = ast.unparse(function.args)
    if skip_self:
        text = re.sub(r"^(self|cls)(, )?", "", text)
        text = re.sub(r"^/(, )?", "", text)
    returns = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"({text}){returns}"


def doc_of(node, live):
    text = ast.get_docstring(node) if isinstance(node, (ast.FunctionDef, ast.ClassDef,
                                                        ast.Module)) else None
    if not text and live is not None:
        try:
            text = inspect.getdoc(live)
        except Exception:  # a computed property may raise
            text = None
        if isinstance(live, (int, float, str, tuple, list, dict)):
            text = None
    lines = (text or "").split("\n")
    while lines and re.match(r"\w+\(.*\)( -> .*)?$",
                             lines[0]):  # pybind11 prints the signature first
        lines = lines[1:]
    return "\n".join(lines).strip()


def decorated(function, name):
    return any(ast.unparse(d).endswith(name) for d in function.decorator_list)


def body(text, indent):
    """Converts a docstring to reStructuredText: paragraphs, and indented lines unchanged."""
    out = []
    for block in re.split(r"\n\s*\n", text):
        lines = block.split("\n")
        if not block.strip():
            continue
        if all(line.startswith((" ", ">>>")) for line in lines if line):
            out += ["::", "", *("   " + line for line in lines), ""]
        else:
            text = " ".join(line.strip() for line in lines)
            text = re.sub(r"`+([^`]+)`+|([*|\\])", lambda m: f"``{m.group(1)}``"
                          if m.group(1) else "\\" + m.group(2), text)
            text = re.sub(r"(\w)_(?=\W|$)", r"\1\\_", text) if "``" not in text else text
            out += [text, ""]
    return [indent + line if line else "" for line in out]


def members(nodes, live, indent, inside):
    lines, seen = [], set()
    for node in nodes:
        if isinstance(node, ast.FunctionDef):
            name = node.name
            dunder = name.startswith("__") and name.endswith("__")
            if (name.startswith("_") and
                    not dunder) or name in ("__init__", "__new__", "__getattr__", "__setattr__",
                                            "__repr__"):
                continue
            if decorated(node, ".setter"):
                continue
            here = getattr(live, name, None) if live is not None else None
            if decorated(node, "property"):
                kind = f" -> {ast.unparse(node.returns)}" if node.returns else ""
                lines += [
                    f"{indent}.. py:property:: {name}",
                    *([f"{indent}   :type: {kind[4:]}"] if kind else []), ""
                ]
                real = inspect.getattr_static(live, name, None) if live is not None else None
                lines += body(doc_of(node, real), indent + "   ")
                continue
            overload = decorated(node, "overload")
            text = f"{name}{signature(node, inside and not decorated(node, 'staticmethod'))}"
            if name in seen:  # another overload
                lines += [
                    f"{indent}.. py:{'method' if inside else 'function'}:: {text}",
                    f"{indent}   :noindex:", ""
                ]
                continue
            seen.add(name)
            lines += [
                f"{indent}.. py:{'method' if inside else 'function'}:: {text}", "",
                *body(doc_of(node, here), indent + "   ")
            ]
            del overload
        elif isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
            here = getattr(live, node.name, None) if live is not None else None
            made = next(
                (n for n in node.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"),
                None)
            bases = [ast.unparse(b) for b in node.bases]
            lines += [
                f"{indent}.. py:class:: {node.name}{signature(made, True).split(' -> ')[0] if made else ''}",
                ""
            ]
            lines += body(
                (f"Kind of {', '.join(bases)}. " if bases and bases != ["object"] else "") +
                doc_of(node, here), indent + "   ")
            lines += members(node.body, here, indent + "   ", True)
        elif isinstance(node, ast.AnnAssign) and isinstance(
                node.target, ast.Name) and not node.target.id.startswith("_"):
            if "TypeAlias" in ast.unparse(node.annotation):
                continue
            lines += [
                f"{indent}.. py:attribute:: {node.target.id}",
                f"{indent}   :type: {ast.unparse(node.annotation)}", ""
            ]
    return lines


def page(package):
    """Returns one page for the package's stubs, without the generated node classes, which have a
    reference of their own."""
    lines = [
        "Python", "======", "",
        "*Made from the package's stubs and docstrings.* :doc:`nodes` lists the fields of every node.",
        ""
    ]
    for stub in sorted(package.glob("*.pyi"), key=lambda p: (p.name != "__init__.pyi", p.name)):
        if stub.name == "nodes.pyi" or (stub.name.startswith("_") and stub.name != "__init__.pyi"):
            continue
        name = "xvrml" if stub.name == "__init__.pyi" else f"xvrml.{stub.stem}"
        try:
            live = importlib.import_module(name)
        except Exception:  # the package is not built: only signatures
            live = None
        tree = ast.parse(stub.read_text(encoding="utf-8"))
        lines += [
            name, "-" * len(name), "", f".. py:module:: {name}", "", *body(doc_of(tree, live), ""),
            *members(tree.body, live, "", False)
        ]
    return "\n".join(lines) + "\n"
