"""Write the outputs that pages show anew, from the twin: `make docs-outputs`, or with the pages to write.

python tests/docs/write_outputs.py [docs/start.md ...]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "support"), str(ROOT / "tests" / "docs")]

from test_pages import PLAYED, TWIN  # noqa: E402

from page_blocks import with_outputs  # noqa: E402
from page_runner import Reader  # noqa: E402


def main() -> None:
    for name in sys.argv[1:] or (*TWIN, *PLAYED):
        page = (ROOT / name).resolve()
        with tempfile.TemporaryDirectory() as folder:
            reader = Reader(Path(folder))
            reader.read(page)
        text = page.read_text()
        for block, outputs in sorted(reader.outputs.items(), key=lambda item: -item[0].start):
            end = block.start + len(block.text)
            text = text[: block.start] + with_outputs(block, outputs) + text[end:]
        page.write_text(text)
        print(name)


if __name__ == "__main__":
    main()
