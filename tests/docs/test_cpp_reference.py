"""The reference of the C++ library: no public symbol is left out, none stands without a word on it."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cpp_reference import HEADERS, Header, Symbol, headers, read_header, reference

HEADER = """// What it is for.
//     torque = K
#pragma once

#include <array>

namespace plantar {

// One tick.
struct Reading {
  double time = 0.0;  // [s]
  std::array<double, 2> place = {0.0, 0.0};

  // Of three axes.
  double origin[3];
};

enum Flag : int {
  SLIP = 1 << 0,  // it slides
  EDGE            // at the edge
};

class Estimator {
 public:
  // Throws.
  explicit Estimator(const Reading& reading,
                     int ticks);
  ~Estimator();

 private:
  struct State;
  int hidden_;
};

}  // namespace plantar
"""


def symbols(header: Header) -> list[Symbol]:
    return [one for symbol in header.symbols for one in symbol.all()]


def read(text: str, folder: Path) -> Header:
    (folder / "made.hpp").write_text(text)
    return read_header(folder / "made.hpp")


def test_what_is_public_is_read_with_what_is_said_of_it(tmp_path: Path) -> None:
    header = read(HEADER, tmp_path)
    assert header.text == "What it is for.\n\n```text\ntorque = K\n```"
    assert [(one.kind, one.name, one.text) for one in symbols(header)] == [
        ("struct", "Reading", "One tick."),
        ("member", "time", "[s]"),
        ("member", "place", ""),
        ("member", "origin", "Of three axes."),
        ("enum", "Flag", ""),
        ("enumerator", "SLIP", "it slides"),
        ("enumerator", "EDGE", "at the edge"),
        ("class", "Estimator", ""),
        ("function", "Estimator", "Throws."),
        ("function", "~Estimator", ""),
    ]
    constructor = symbols(header)[-2]
    assert constructor.declaration == "explicit Estimator(const Reading& reading, int ticks)"


@pytest.mark.parametrize(
    "line",
    [
        "template <class T>",
        "#define X 1",
        "enum class State { air, stance };",
        "    // goes on",
        "inline int f() {",
    ],
)
def test_a_line_that_is_not_understood_stops_the_site(line: str, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"made\.hpp:10: "):
        read(HEADER.replace("// One tick.\nstruct", f"// One tick.\n{line}\nstruct"), tmp_path)


def test_every_public_symbol_is_documented() -> None:
    found = [f"{header.name}: {one.name}" for header in headers() for one in symbols(header) if not one.text]
    assert found == []


def test_the_page_has_every_name_that_a_user_can_write() -> None:
    """By another way than the reader of headers: each word that a declaration ends with."""
    page = reference()
    for path in HEADERS.glob("*.hpp"):
        code = re.sub(r"//.*|#.*", "", path.read_text()).partition("private:")[0]
        for name in re.findall(
            r"(\w+)(?:\[\d+\])?(?: = [^;]*)?;|(\w+)\(|^  (\w+)(?: = .*)?,?$|(?:struct|class) (\w+)",
            code,
            re.M,
        ):
            word = next(part for part in name if part)
            assert re.search(rf"\{{cpp:.*\b{word}\b", page), f"{path.name}: {word}"
