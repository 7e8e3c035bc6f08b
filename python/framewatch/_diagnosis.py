# SPDX-License-Identifier: MIT
"""The result of a diagnosis as plain objects."""
from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Optional


@dataclass(frozen=True)
class Value:
    """A parameter of an effect. std_error is None if it is unknown."""

    value: Optional[float]
    unit: str
    std_error: Optional[float]


@dataclass(frozen=True)
class Effect:
    """An effect that the linear model lacks, such as friction.

    name: the effect, as in docs/effects.md.
    place: "kind" (frame, panel, node, floor, base, channel, building) and what names the place:
        "story", "frame", ...
    parameters: by name.
    confidence: 0 to 1. grade: how certain the name is.
    gap_before, gap_after: free-run NRMSE of the held-out records without and with the effect.
    alike: names that the records cannot tell from this one.
    """

    name: str
    place: dict[str, Any]
    parameters: dict[str, Value]
    confidence: Optional[float]
    grade: str
    gap_before: Optional[float]
    gap_after: Optional[float]
    alike: list[str]


@dataclass(frozen=True)
class Gap:
    """Free-run NRMSE of the records, a share: 0 is a perfect model.

    train, held_out: over all channels. channels: of the held-out records, by channel.
    """

    train: Optional[float]
    held_out: Optional[float]
    channels: dict[str, Optional[float]]


@dataclass(frozen=True)
class Place:
    """A place that could explain the gap, the likeliest first.

    misfit_ratio: misfit if any force were allowed there; 1 if only noise is left.
    """

    place: dict[str, Any]
    misfit_ratio: Optional[float]


@dataclass(frozen=True)
class Diagnosis:
    """What a linear model lacks to repeat a building's records, and where.

    verdict: "adequate", "explained", "partly_explained" or "unexplained".
    effects: what was found, in order. places: the likeliest places.
    gap_before, gap_after, noise_floor: of the linear model, of the model with the effects, and of
        a perfect one.
    not_done: what the search did not do within its limit of time; empty: it did all.
    text: what `framewatch diagnose` prints. report_html: its page.
    json: all of it, schema framewatch.diagnosis/1 (docs/formats.md).
    """

    verdict: str
    reason: str
    effects: list[Effect]
    places: list[Place]
    gap_before: Gap
    gap_after: Gap
    noise_floor: Gap
    not_done: list[str]
    text: str
    report_html: str
    json: dict[str, Any]

    @property
    def names(self) -> list[str]:
        """Names of the effects found."""
        return [effect.name for effect in self.effects]

    @classmethod
    def _of(cls, result: dict[str, str]) -> Diagnosis:
        all_of_it = json.loads(result["json"])
        return cls(
            verdict=all_of_it["verdict"],
            reason=all_of_it.get("reason", ""),
            effects=[_effect(e) for e in all_of_it["effects"]],
            places=[Place(w["location"], w["misfit_ratio_if_free"]) for w in all_of_it["where"]],
            gap_before=_gap(all_of_it["gap"]["before"]),
            gap_after=_gap(all_of_it["gap"]["after"]),
            noise_floor=_gap(all_of_it["gap"]["noise_floor"]),
            not_done=all_of_it["search"]["not_done"],
            text=result["text"],
            report_html=result["report_html"],
            json=all_of_it,
        )


def _effect(e: dict[str, Any]) -> Effect:
    return Effect(
        name=e["effect"],
        place=e["location"],
        parameters={
            name: Value(p["value"], p["unit"], p.get("std_error"))
            for name, p in e["parameters"].items()
        },
        confidence=e["confidence"],
        grade=e["grade"],
        gap_before=e["holdout_nrmse_before"],
        gap_after=e["holdout_nrmse_after"],
        alike=e["indistinguishable_from"],
    )


def _gap(gap: dict[str, Any]) -> Gap:
    return Gap(gap["train"]["overall"], gap["holdout"]["overall"], gap["holdout"]["channels"])
