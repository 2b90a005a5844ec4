"""Preprocessor of the book: a page of all that the Python package offers, below the page about it. Signatures come from the
stubs and the sources in Python; texts of the native half are the comments in Rust that `help` shows, too.

`python3 .ci/book_python.py page` prints the page.
"""

import ast
import inspect
import json
import re
import sys
from pathlib import Path

BINDINGS = Path(__file__).resolve().parents[1] / "bindings/python"
PACKAGE = BINDINGS / "python/mppflight"
# What is imported by a name of its own, after the package itself.
MODULES = ("environments", "benchmark", "fit")
CONSTRUCTORS = ("__new__", "__init__")


def native_texts() -> dict[str, str]:
    """The texts of the native classes and functions by name, of members as `Class.member`."""
    texts: dict[str, str] = {}
    for source in sorted((BINDINGS / "src").glob("*.rs")):
        owner, text = "", []
        for line in map(str.strip, source.read_text().splitlines()):
            found = re.match(r"(?:pub(?:\(crate\))? )?(struct|fn|impl) (\w+)", line)
            if line.startswith("///"):
                text.append(line[3:].removeprefix(" "))
            elif line.startswith("#[pyfunction"):
                owner = ""
            elif found and found[1] == "impl":
                owner = found[2] + "."
            elif found:
                texts.setdefault((owner if found[1] == "fn" else "") + found[2], "\n".join(text))
            if found or not line:
                text = []
    return texts


class Source:
    """A file of the package, stub or Python: what it defines."""

    def __init__(self, name: str) -> None:
        text = (PACKAGE / name).read_text()
        self.lines, self.tree = text.splitlines(), ast.parse(text)
        # Of overloads the first.
        nodes = [node for node in self.tree.body if isinstance(node, ast.ClassDef | ast.FunctionDef)]
        self.defined = {node.name: node for node in reversed(nodes)}
        self.native = native_texts() if name.endswith(".pyi") else {}

    def head(self, node: ast.FunctionDef) -> str:
        """A function up to its body, as it is written."""
        shown = self.lines[node.lineno - 1 : node.body[0].lineno]
        shown = shown if shown[-1].endswith(": ...") else shown[:-1]
        return inspect.cleandoc("\n".join(shown)).removesuffix(" ...").removesuffix(":")

    def heads(self, name: str) -> str:
        """A function of the module, or all its overloads."""
        return "\n".join(self.head(node) for node in self.tree.body if isinstance(node, ast.FunctionDef) and node.name == name)

    def text(self, path: str, node: ast.AST) -> str:
        return self.native.get(path) or ast.get_docstring(node) or ""

    def members(self, node: ast.ClassDef) -> dict[str, ast.FunctionDef]:
        """The constructor and the public members of a class, with those of bases that nobody sees."""
        found: dict[str, ast.FunctionDef] = {}
        for base in node.bases:
            name = ast.unparse(base).partition("[")[0]
            if name.startswith("_"):
                found |= self.members(self.defined[name])
        own = {one.name: one for one in node.body if isinstance(one, ast.FunctionDef)}
        return found | {name: one for name, one in own.items() if name in CONSTRUCTORS or not name.startswith("_")}

    def entry(self, name: str) -> str:
        """A name with its text, a class with its members."""
        node = self.defined.get(name)
        if node is None:
            values = {ast.unparse(one.target): one for one in self.tree.body if isinstance(one, ast.AnnAssign)}
            return titled("###", name, ast.unparse(values[name]), "")
        if isinstance(node, ast.FunctionDef):
            return titled("###", name, self.heads(name), self.text(name, node))
        members = self.members(node)
        bases = ", ".join(ast.unparse(base) for base in node.bases if not ast.unparse(base).startswith("_"))
        inside = [ast.unparse(one) for one in node.body if isinstance(one, ast.AnnAssign)]
        inside += [self.head(members.pop(one)) for one in CONSTRUCTORS if one in members]
        inside = ["    " + line for one in inside for line in one.splitlines()]
        head = "\n".join([f"class {name}{f'({bases})' if bases else ''}", *inside])
        parts = [titled("###", name, head, self.text(name, node))]
        for member, one in members.items():
            is_property = any(ast.unparse(decorator) == "property" for decorator in one.decorator_list)
            shown = f"{member}: {ast.unparse(one.returns)}" if is_property else self.head(one)
            parts.append(titled("####", f"{name}.{member}", shown, self.text(f"{name}.{member}", one)))
        return "\n\n".join(parts)


def titled(level: str, name: str, code: str, text: str) -> str:
    return f"{level} `{name}`\n\n```python\n{code}\n```\n\n{text}".rstrip()


def page() -> str:
    """The whole page."""
    parts = ["# Python: every name", "First steps are in [Python](python.md).", "## `mppflight`"]
    imports = [node for node in Source("__init__.py").tree.body if isinstance(node, ast.ImportFrom) and node.module]
    homes = {alias.name: node.module for node in imports for alias in node.names}
    sources = {home: Source(home + (".pyi" if home == "_native" else ".py")) for home in homes.values()}
    parts += [sources[homes[name]].entry(name) for name in sorted(homes, key=str.lower)]
    for name in MODULES:
        source = Source(f"{name}.py")
        parts += [f"## `mppflight.{name}`", ast.get_docstring(source.tree) or ""]
        own = [one for one, node in source.defined.items() if one[0] != "_" and one != "main" and ast.get_docstring(node)]
        parts += [source.entry(one) for one in reversed(own)]
    keys = (PACKAGE / "keys.py").read_text()
    parts += ["## Keys of scenarios", f"```python\n{keys[keys.index('Preset:'):].strip()}\n```"]
    return "\n\n".join(parts) + "\n"


def add(items: list) -> None:
    """Puts the page below that of python.md."""
    for item in items:
        chapter = item.get("Chapter") if isinstance(item, dict) else None
        if chapter and chapter.get("path") == "python.md":
            chapter["sub_items"].append({"Chapter": {
                "name": "Every name", "content": page(), "number": [*chapter["number"], 1], "sub_items": [],
                "path": "python-names.md", "source_path": None, "parent_names": [chapter["name"]]}})


def main() -> None:
    if sys.argv[1:2] == ["supports"]:
        return
    if sys.argv[1:2] == ["page"]:
        print(page(), end="")
        return
    _, book = json.load(sys.stdin)
    add(book.get("items") or book["sections"])
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
