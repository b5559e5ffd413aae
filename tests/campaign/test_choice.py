"""The most informative motions beside those that the paper composed."""

from __future__ import annotations

from dataclasses import replace

from plantar.campaign.choice import COMPOSED, TOGETHER, choice_rows, choice_table, explained
from plantar.motions.select_motions import Choice, Selection


def test_the_choice_of_motions_is_set_beside_the_papers() -> None:
    def choice(width: float, *motions: str) -> Choice:
        widths = {("left", "pitch", "stiffness"): width / 2, ("left", "roll", "damping"): 2 * width}
        return Choice(motions, widths, 1.0)

    best = (choice(3.0, "a"), choice(0.9, "a", "b"), choice(0.5, "a", "b", "c"))
    paper = choice(1.0, "a", "c", "d")
    found = Selection((), best, choice(0.4, *"abcd"), paper)
    table = choice_table(found)
    assert [row[0].text for row in table.rows] == ["best of 1", "best of 2", "best of 3", COMPOSED, TOGETHER]
    assert [cell.text for cell in table.rows[3][1:4]] == ["a, c, d", "1.0 %", "2.0 % (C left roll)"]
    said = "promises 1.0 %, the best set of 3 0.50 %; 2 suffice for what the composed motion promises."
    assert explained(found).endswith(said)
    assert explained(replace(found, compared=choice(0.5, "c", "b", "a"))).endswith(
        "no other set of 3 promises more."
    )
    as_many = replace(found, best=(choice(3.0, "a"), choice(2.0, "a", "b"), choice(0.5, "a", "b", "c")))
    assert explained(as_many).endswith("the best set of 3 0.50 %."), "three for three is no gain"
    assert choice_rows(found)[3]["half_widths"][1]["percent"] == 2.0
