"""The reference of the C++ library, read from its headers: the directive `cpp-reference`.

It reads the C++ that these headers are written in, laid out by clang-format, and no more: a line that it does not
understand is an error, so that no symbol is left out unseen. What a symbol is for stands in the comment above it, or
behind it on its own line.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

HEADERS = Path(__file__).resolve().parents[2] / "cpp" / "include" / "plantar"
NAMESPACE = "plantar"
OPENS = re.compile(r"(?:(struct|class)|(enum)(?: class)?) (\w+)(?: : [\w:]+)? \{")
IGNORED = re.compile(r"#(?:pragma|include) .*|namespace \w+ \{|\}|struct \w+;")


@dataclass
class Symbol:
    """A struct, class, enum, enumerator, member or function, with what its comment says."""

    kind: str
    name: str
    declaration: str
    text: str
    members: list[Symbol] = field(default_factory=list)

    def all(self) -> Iterator[Symbol]:
        """Itself and all that is in it."""
        yield self
        for member in self.members:
            yield from member.all()


@dataclass
class Header:
    """One header: what its first comment says, and its public symbols in their order."""

    name: str
    text: str
    symbols: list[Symbol]


def read_header(path: Path) -> Header:
    """The public symbols of a header. ValueError with file and line where one is not understood."""
    lines = path.read_text(encoding="utf-8").splitlines()
    first = next((number for number, line in enumerate(lines) if not line.startswith("//")), len(lines))
    header = Header(path.name, joined(lines[:first]), [])
    scope: Symbol | None = None
    public, above, begun = True, [], ""
    for number, line in enumerate(lines[first:], start=first + 1):
        code, _, behind = (part.strip() for part in line.partition("//"))
        if not code and behind and line.startswith("    "):
            raise ValueError(f"{path.name}:{number}: a comment behind a line goes on here: put it above")
        if not code:
            above = [*above, line.strip()] if behind else []
            continue
        begun = f"{begun} {code}".strip()
        comment = behind or joined(above)
        into = header.symbols if scope is None else scope.members
        if scope is not None and begun == "};":
            scope = None
        elif begun in ("public:", "private:", "protected:"):
            public = begun == "public:"
        elif opened := OPENS.fullmatch(begun):
            scope = Symbol(opened[1] or opened[2], opened[3], begun.removesuffix(" {"), comment)
            header.symbols.append(scope)
            public = opened[1] != "class"
        elif scope is not None and scope.kind == "enum":
            value = begun.rstrip(",")
            scope.members.append(Symbol("enumerator", value.split(" ")[0], value, comment))
        elif begun.endswith(";") and not IGNORED.fullmatch(begun):
            if public:
                into.append(declared(begun.removesuffix(";"), comment, f"{path.name}:{number}"))
        elif begun.endswith((",", "(")):
            continue
        elif not IGNORED.fullmatch(begun):
            raise ValueError(f"{path.name}:{number}: not understood: {begun}")
        above, begun = [], ""
    return header


def declared(text: str, comment: str, where: str) -> Symbol:
    """A function or a member. ValueError where it is neither."""
    plain = text.removeprefix("explicit ")
    if call := re.search(r"(~?\w+|operator\W+)\(", plain):
        return Symbol("function", call[1], text, comment)
    found = re.fullmatch(r"[\w:<>, ]+ (\w+)(?:\[\d+\])?(?: = .*)?", plain)
    if found is None:
        raise ValueError(f"{where}: not understood: {text}")
    return Symbol("member", found[1], text, comment)


def joined(comment: list[str]) -> str:
    """The lines of a comment as Markdown; indented ones stay as they are, as code."""
    said: list[str] = []
    for line in comment:
        text = line.removeprefix("//").removeprefix(" ")
        if text.startswith("    "):
            said.append(f"\n```text\n{text.strip()}\n```\n")
        elif not text:
            said.append("\n\n")
        else:
            said.append(text)
    return "\n".join(said).strip()


def headers() -> list[Header]:
    """Every installed header."""
    return [read_header(path) for path in sorted(HEADERS.glob("*.hpp"))]


def reference() -> str:
    """All headers as Markdown, each symbol as a directive of Sphinx's C++ domain, so that search and links find it."""
    return "\n\n".join(section(header) for header in headers())


def section(header: Header) -> str:
    parts = [f"## plantar/{header.name}", header.text, f"```{{cpp:namespace}} {NAMESPACE}\n```"]
    return "\n\n".join([*parts, *(directive(symbol) for symbol in header.symbols)])


def directive(symbol: Symbol, fence: str = "`````") -> str:
    """A symbol and what is in it; of the struct's own words the domain wants the name only."""
    declaration = re.sub(r"^(struct|class|enum class|enum) ", "", symbol.declaration)
    kind = symbol.declaration.split(f" {symbol.name}")[0] if symbol.kind == "enum" else symbol.kind
    kind = {"enum class": "enum-class"}.get(kind, kind)
    inside = "\n\n".join([symbol.text, *(directive(one, fence[:-1]) for one in symbol.members)])
    return f"{fence}{{cpp:{kind}}} {declaration}\n{inside}\n{fence}"


def setup(app: Any) -> dict[str, Any]:
    """Make the directive known to Sphinx."""
    from sphinx.util.docutils import SphinxDirective

    class CppReference(SphinxDirective):
        """` ```{cpp-reference} ` in a page: all headers in its place."""

        def run(self) -> list[Any]:
            for path in HEADERS.glob("*.hpp"):
                self.env.note_dependency(str(path))
            return list(self.parse_text_to_nodes(reference(), allow_section_headings=True))

    app.add_directive("cpp-reference", CppReference)
    return {"parallel_read_safe": True}
