"""The feet report: what it says, what it holds, and that nothing hostile gets through."""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from plantar.errors import PlantarError
from plantar.report import Column, Figure, Section, Table, write_feet_report
from plantar.report.feet import feet_page
from plantar.report.page import embed
from plantar.results.feet import FeetResult
from report_samples import HOSTILE, MOTIONS, Campaign, write_campaign

FIVE_MEGABYTES = 5_000_000


class Page(HTMLParser):
    """Every tag with its attributes, and the texts of scripts, styles, captions and verdicts."""

    def __init__(self, path: Path) -> None:
        super().__init__(convert_charrefs=True)
        self.source = path.read_text(encoding="utf-8")
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.texts: dict[str, list[str]] = {}
        self.plain = ""
        self._open: list[str] = []
        self.feed(self.source)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._open.append(tag)
        self.texts.setdefault(tag, []).append("")

    def handle_endtag(self, tag: str) -> None:
        if tag in self._open:
            while self._open.pop() != tag:
                pass

    def handle_data(self, data: str) -> None:
        if self._open and self._open[-1] in self.texts:
            self.texts["caption" if "caption" in self._open else self._open[-1]][-1] += data
        if not self._open or self._open[-1] not in ("script", "style"):
            self.plain += data

    def of(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    return write_campaign(tmp_path_factory.mktemp("campaign"))


@pytest.fixture(scope="module")
def page(campaign: Campaign) -> Page:
    path = write_feet_report(campaign.directory)
    assert path == campaign.directory / "report.html"
    return Page(path)


def test_the_whole_campaign_stays_under_five_megabytes(campaign: Campaign, page: Page) -> None:
    assert campaign.rows == len(MOTIONS) * 2 * 60 * 200
    assert len(page.source.encode()) < FIVE_MEGABYTES


def test_the_verdict_comes_first_and_in_plain_words(page: Page) -> None:
    words = " ".join(page.plain.split())
    assert "left pitch: K = 480.0 ± 1.0 N·m/rad, C = 24.3 ± 0.4 N·m·s/rad — usable." in words
    assert "K = 323.0 ± 1.0 N·m/rad (weak), C cannot be told from these logs." in words
    assert "not for squat right roll (" in words
    assert "Record 60 s of manual_right_roll to halve the widest interval." in words
    assert words.index("Record 60 s") < words.index("Table 1")


def test_an_unidentifiable_number_is_not_given_in_the_verdict(page: Page) -> None:
    verdict = page.plain[: page.plain.index("Table 1")]
    assert "17.5" not in verdict


def test_every_table_has_its_caption(page: Page) -> None:
    captions = page.texts["caption"]
    for wanted in (
        "Table 1.",
        "Table 2.",
        "Table 3.",
        "Offsets",
        "Compared: offset shared",
        "What is used",
        "Inputs",
    ):
        assert any(wanted in caption for caption in captions), wanted
    assert len(page.of("table")) == len(captions)


def test_a_model_without_skill_is_marked(page: Page) -> None:
    assert [text for text in page.texts["td"] if text == "none"] == ["none"]
    assert sum("% better" in text for text in page.texts["td"]) == 27


def test_the_comparison_shows_how_far_the_shared_offset_is_off(page: Page) -> None:
    assert page.texts["td"].count("+5.0 %") == 8


def test_phases_carry_their_reasons(page: Page) -> None:
    titles = page.texts["title"]
    assert any("the foot is in the air" in title for title in titles)
    assert any("sole tips over its edge in <b>tilt3</b>" in title for title in titles)


def test_nothing_is_loaded_from_anywhere(page: Page) -> None:
    for tag, attributes in page.tags:
        assert tag not in ("link", "iframe", "object", "embed", "base", "form"), tag
        for name in ("src", "href", "srcset", "data", "action"):
            value = attributes.get(name)
            assert value is None or value.startswith(("#", "data:image/")), (tag, name, value)
    own = [text for text in page.texts["style"] + page.texts["script"] if "uPlot (v" not in text]
    assert not any(re.search(r"https?://|@import|url\(", text) for text in own)


def test_hostile_names_stay_text(page: Page) -> None:
    assert page.of("img") == []
    assert page.of("b") == []
    assert not any(name.startswith("on") for _, attributes in page.tags for name in attributes)
    assert HOSTILE in page.plain
    blocks = re.findall(
        r'<script type="application/json" class="header"[^>]*>(.*?)</script>', page.source, re.S
    )
    assert len(blocks) == len(MOTIONS)
    assert all(json.loads(block)["tracks"] for block in blocks)


def test_a_hostile_foot_cannot_leave_its_data_block(tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path, seconds=2.0)
    columns = {name: values.copy() for name, values in campaign.columns.items()}
    columns["foot"][columns["foot"] == "left"] = HOSTILE
    import pyarrow as pa
    import pyarrow.parquet

    pyarrow.parquet.write_table(pa.table(columns), tmp_path / "residuals.parquet")
    page = Page(write_feet_report(tmp_path))
    assert page.of("img") == []
    scripts = zip(page.texts["script"], page.of("script"), strict=True)
    blocks = [text for text, tag in scripts if tag.get("class") == "header"]
    assert not any(re.search("[<>&\u2028\u2029]", block) for block in blocks)
    feet = {track["foot"] for block in blocks for track in json.loads(block)["tracks"]}
    assert feet == {HOSTILE, "right"}


def test_the_policy_allows_these_scripts_and_styles_alone(page: Page) -> None:
    policy = next(
        tag["content"] for tag in page.of("meta") if tag.get("http-equiv") == "Content-Security-Policy"
    )
    assert policy is not None
    assert policy.startswith("default-src 'none'; ")
    assert "unsafe" not in policy
    directives = dict(each.split(" ", 1) for each in policy.split("; "))
    scripts = [
        text for text, tag in zip(page.texts["script"], page.of("script"), strict=True) if "type" not in tag
    ]
    for text in [*scripts, *page.texts["style"]]:
        digest = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
        assert (
            f"'sha256-{digest}'" in directives["style-src" if text in page.texts["style"] else "script-src"]
        )
    assert policy.count("sha256-") == len(scripts) + len(page.texts["style"])


def test_a_campaign_too_long_is_thinned_and_says_so(
    campaign: Campaign, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("plantar.report.payload.encode.__defaults__", (300_000,))
    path = write_feet_report(campaign.directory, tmp_path / "thin.html")
    text = path.read_text(encoding="utf-8")
    assert len(text) < 900_000
    assert re.search(r"Every \d+\. sample is drawn; all of them are in residuals.parquet", text)


def test_without_residuals_the_numbers_still_come(campaign: Campaign, tmp_path: Path) -> None:
    (tmp_path / "result.json").write_text(json.dumps(campaign.result), encoding="utf-8")
    page = Page(write_feet_report(tmp_path / "result.json", tmp_path / "sub" / "page.html"))
    assert "No residuals lie beside the result" in " ".join(page.plain.split())
    assert page.of("figure") == []
    assert any("Table 3." in caption for caption in page.texts["caption"])


def test_extra_figures_and_sections_are_shown(campaign: Campaign, tmp_path: Path) -> None:
    svg = b'<svg xmlns="http://www.w3.org/2000/svg"><script>alert(1)</script></svg>'
    figure = Figure("Figure 4.", "ZMP <i>in</i> the polygon", svg)
    table = Table.of("Beside the paper", [Column("a", numeric=False), Column("b")], [("x", "1")])
    section = Section("Beside the paper's numbers", ("First <b>paragraph</b>.",), (table,))
    result = campaign.result | {"phases": []}
    (tmp_path / "result.json").write_text(json.dumps(result), encoding="utf-8")
    page = Page(write_feet_report(tmp_path, figures=[figure], sections=[section]))
    assert [tag["src"] for tag in page.of("img")] == [figure.data_uri]
    assert "ZMP <i>in</i> the polygon" in page.plain
    assert "Beside the paper" in page.texts["caption"]
    assert page.of("i") == []


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "plantar.inertia/1"}, "plantar.inertia/1"),
        ({"parameters": "none"}, "parameters"),
        ({"parameters": [{"foot": "left", "axis": "pitch", "name": "K"}]}, "parameters.0.unit"),
        (
            {"phases": [{"motion": "a", "foot": "b", "start": "now", "end": 1, "support": "x", "used": 1}]},
            "start",
        ),
    ],
)
def test_a_wrong_result_is_one_line(
    campaign: Campaign, tmp_path: Path, change: dict[str, object], message: str
) -> None:
    (tmp_path / "result.json").write_text(json.dumps(campaign.result | change), encoding="utf-8")
    with pytest.raises(PlantarError, match=re.escape(message)) as error:
        write_feet_report(tmp_path)
    assert "\n" not in str(error.value)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["result.json"]


def test_cut_residuals_are_one_line(tmp_path: Path) -> None:
    campaign = write_campaign(tmp_path, seconds=2.0)
    file = campaign.directory / "residuals.parquet"
    file.write_bytes(file.read_bytes()[:500])
    with pytest.raises(PlantarError, match=re.escape("residuals.parquet")) as error:
        write_feet_report(tmp_path)
    assert "\n" not in str(error.value)


def test_the_page_of_a_result_in_memory_is_that_of_its_file(campaign: Campaign, page: Page) -> None:
    assert feet_page(FeetResult.load(campaign.directory)) == page.source


def test_data_in_a_page_end_no_block_and_are_json() -> None:
    told = embed({"a": ['</script>&\xe9"', math.nan, -math.inf, 0.1], "b": None})
    assert told == r'{"a":["\u003c/script\u003e\u0026\u00e9\"",null,null,0.1],"b":null}'
