"""A question in the place of a conclusion, in words."""

from __future__ import annotations

from hersey.decision.plausibility import Question
from hersey.errors import Setting
from hersey.study.findings import Findings
from hersey.study.first_screen.missing import missing
from hersey.study.first_screen.result import DecisionPart, PointDecisionPart
from hersey.study.first_screen.words import figures, mm


def unanswered(
    question: Question,
    known: Findings,
) -> DecisionPart:
    """Return the first screen of a log whose numbers cannot be what they are called."""
    text, remedy = in_words(question)
    return DecisionPart(
        signal="act",
        instruction=text,
        interval="",
        otherwise=f"{remedy} Until then, nothing is concluded.",
        points=[
            PointDecisionPart(
                name=point.name,
                speed=point.speed,
                temperature=point.temperature,
                signal="watch",
                words="not judged until the question is answered",
            )
            for point in (known.machine.points if known.machine is not None else ())
        ],
        flags=[],
        missing=missing(known),
    )


def in_words(question: Question) -> tuple[str, str]:
    """Return the question, and what to do if the answer is yes."""
    times = figures(question.times)
    of = {
        "motor": "your motor's limit",
        "friction": "what friction in the nip allows",
        "drive": "your drive's maximum speed",
        "usual": "the usual value of such machines",
    }[question.of]
    if question.kind == "swapped":
        torque, speed = Setting("torque", "channel"), Setting("speed", "channel")
        return (
            f"Are the torque and speed columns swapped? Torque is {times} times {of}",
            f"Name the columns with {torque.to()} and {speed.to()}.",
        )
    if question.kind == "radius unit":
        return (
            f"Is the radius {figures(1e3 * question.value)} mm? That is {figures(question.value)} m",
            "Correct roll_radius in the machine file.",
        )
    if question.kind == "torque unit":
        unit = "Is torque in mN·m?" if question.thousandfold else "Is the unit of torque right?"
        return f"{unit} It is {times} times {of}", f"Give the unit with {Setting('torque', 'unit').to()}."
    faster = f"The surface would run at {mm(question.value)} mm/s, {times} times {of}"
    return (
        f"Is the unit of speed right? {faster}",
        f"Give the unit with {Setting('speed', 'unit').to()}, or correct roll_radius.",
    )
