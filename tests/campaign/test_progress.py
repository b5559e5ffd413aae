"""How far a campaign is, which of its motions are played again, and what its choice of motions is called."""

from __future__ import annotations

from plantar.campaign.choice import explained
from plantar.campaign.run import Course, shares
from plantar.motions.select_motions import Choice, Selection


def test_jobs_are_told_together_every_twentieth_and_never_twice() -> None:
    said: list[str] = []
    report = shares("replay 2 times", 2, said.append)
    for job, share in (("a", 0.0), ("a", 0.05), ("b", 0.05), ("b", 0.5), ("a", 0.04), ("a", 1.0), ("b", 1.0)):
        report(job, share)
    assert said == [f"replay 2 times: {percent} %" for percent in (0, 5, 25, 75, 100)]


def test_a_course_keeps_what_was_played() -> None:
    course = Course(("a", "b"), ("c", "d", "e"), ("d", "e"), ("JRL",))
    assert course.motions == ("a", "b", "c", "d", "e")
    kept = course.only(["a", "b", "d", "c"])
    assert (kept.fit, kept.validate, kept.replayed, kept.guesses) == (
        ("a", "b"),
        ("c", "d"),
        ("d",),
        ("JRL",),
    )
    quick = Course.quick()
    assert (quick.fit, quick.validate, quick.replayed, quick.guesses) == (
        ("Tilt3",),
        ("Squat",),
        ("Squat",),
        (),
    )


def test_the_ranking_is_explained_in_whole_sentences() -> None:
    def choice(width: float, *motions: str) -> Choice:
        return Choice(motions, {("left", "pitch", "stiffness"): width}, 1.0)

    first = (
        "95 % half widths that a spring-damper fit to a set promises, in percent of the value, from its information "
        "matrices and from autocorrelated residuals; usual is their geometric mean over every K and C. "
    )
    best = (choice(3.0, "a"), choice(1.5, "a", "b"), choice(0.5, "a", "b", "c"))
    for compared, rest in (
        (None, ""),
        (choice(1.0, "b", "c", "d"),
         "The paper's composed motion promises 1.0 %, the best set of 3 0.50 %."),
        (choice(2.0, "b", "c", "d"),
         "The paper's composed motion promises 2.0 %, the best set of 3 0.50 %; 2 suffice for what the composed motion "
         "promises."),
        (choice(0.5, "c", "b", "a"),
         "The paper's composed motion promises 0.50 %: no other set of 3 promises more."),
        (choice(4.0, "a", "b", "c", "d"),
         "The paper's composed motion promises 4.0 %, the best set of 3 0.50 %; 1 suffice for what the composed motion "
         "promises."),
    ):  # fmt: skip
        assert explained(Selection((), best, best[-1], compared)) == first + rest
