"""One HTML file that needs nothing else: scripts and styles inside, allowed by their hash, the network forbidden."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from markupsafe import Markup

from plantar.results.io import finite

if TYPE_CHECKING:
    from jinja2 import Environment

_HERE: Final = Path(__file__).parent
_VENDORED: Final = {"uPlot.iife.min.js", "uPlot.min.css"}


def render(template: str, *, styles: Sequence[str], scripts: Sequence[str] = (), **context: Any) -> str:
    """The page of `templates/<template>` with the named style sheets and scripts inside.

    Everything in `context` is escaped by the template; nothing of it can become a script, because the page's
    content policy lists the hashes of exactly these scripts and styles.
    """
    style_texts = [_asset(name) for name in styles]
    script_texts = [_asset(name) for name in scripts]
    page = _templates().get_template(template)
    return page.render(
        styles=[Markup(text) for text in style_texts],
        scripts=[Markup(text) for text in script_texts],
        policy=content_policy(script_texts, style_texts),
        **context,
    )


def get_ready(*names: str) -> None:
    """Compile templates, which takes longer than to fill them in, before these are asked for."""
    for name in names:
        _templates().get_template(name)


@cache
def _templates() -> Environment:
    """All templates; it keeps those that it has compiled."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined  # costs start-up

    environment = Environment(
        loader=FileSystemLoader(_HERE / "templates"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["embed"] = embed
    return environment


def content_policy(scripts: Sequence[str], styles: Sequence[str]) -> str:
    """The page's Content-Security-Policy: these scripts and styles, embedded pictures, nothing else."""
    return "; ".join(
        [
            "default-src 'none'",
            " ".join(["script-src", *map(_hashed, scripts)]) if scripts else "script-src 'none'",
            " ".join(["style-src", *map(_hashed, styles)]),
            "img-src data:",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )


def embed(data: Any) -> Markup:
    """JSON for a data block inside HTML: no `<`, `>` or `&`, ASCII only, null for NaN and infinity."""
    text = json.dumps(finite(data), ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return Markup(text.replace("&", r"\u0026").replace("<", r"\u003c").replace(">", r"\u003e"))


def _asset(name: str) -> str:
    folder = "vendor" if name in _VENDORED else "templates"
    return (_HERE / folder / name).read_text(encoding="utf-8")


def _hashed(text: str) -> str:
    digest = hashlib.sha256(text.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode('ascii')}'"
