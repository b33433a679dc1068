"""`Study`: the settings of a plan, measured in turns within a budget."""

from __future__ import annotations

import time
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from obbcli.accuracy import Accuracy
from obbcli.answers.status import Status
from obbcli.errors import MotionError
from obbcli.motion.body import as_body
from obbcli.questions.first_contact import first_contact
from obbcli.questions.pair_question import duration_of
from obbcli.questions.query import Query
from obbcli.study.tradeoff.judge import Judge
from obbcli.study.tradeoff.settings import Scale, Setting, levels_of, plan, reference_of
from obbcli.study.tradeoff.taking_turns import fair_part, no_collections
from obbcli.study.tradeoff.trees import Built, Trees
from obbcli.study.tradeoff.trials import Timing, Tradeoff, Trial, Unreached, front_of
from obbcli.tree.options import DEFAULT_BUILD

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from obbcli.answers.contact import FirstContact
    from obbcli.motion.body import Body, Shape

    # Takes about how many seconds are left, and how many settings are measured.
    Progress = Callable[[float, int], object]

# Of the budget that is left: what builds and first calls may take, then the early turns, then the
# first calls of what is crossed.
_FIRST_SHARE, _EARLY_SHARE, _CROSSED_SHARE = 0.5, 0.3, 0.3
# Turns: before the best trees and methods are crossed, and in all.
_EARLY_ROUNDS, _ROUNDS = 5, 25
# How many trees, the fastest under the default question, are asked with the front's methods.
_CROSSED_TREES = 3


@dataclass
class _Entry:
    """A setting under measurement."""

    setting: Setting
    built: Built
    answer: FirstContact
    first: float
    times: list[float] = field(default_factory=list)

    @property
    def timing(self) -> Timing:
        return Timing.of(self.times, self.first)


class Study:
    """The trade of one question. `run` may be interrupted: `result` has what was measured by then.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
            A tree is used as it is; to see how others would do, give the mesh.
        b: the other shape, of the same kinds.
        duration: s; None: 1 where a body moves, else 0.
        accuracy: what the user would ask with: it is measured as well, and all settings share its
            `clearance`, `max_iterations` and `timeout`. None: the defaults.
        budget: s that the whole study may take. The reference answer comes first and is not cut
            short but by that.

    Attributes:
        duration: s, as resolved.

    Raises:
        MotionError: the duration or the budget is negative or not finite.
        MeshError: a mesh cannot be read or is refused.
        TreeFileError: a tree file is damaged.
        OSError: a file cannot be read.
    """

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        duration: float | None = None,
        accuracy: Accuracy | None = None,
        *,
        budget: float = 60.0,
    ) -> None:
        self._budget = _seconds(budget)
        bodies = as_body(a), as_body(b)
        self.duration = duration_of(duration, bodies)
        self._trees = Trees(bodies)
        self._asked = Accuracy() if accuracy is None else accuracy
        self._reference_accuracy = reference_of(self._asked, self.duration)
        self._reference: FirstContact | None = None
        self._judge: Judge | None = None
        self._entries: dict[Setting, _Entry] = {}
        self._unreached: dict[Setting, str] = {}
        self._begun = time.perf_counter()

    @property
    def has_reference(self) -> bool:
        """Whether the answer that errors are measured against is known."""
        return self._judge is not None

    @property
    def bodies(self) -> tuple[Body, Body]:
        """A and B over the meshes or trees that they came with."""
        return self._trees.bodies

    def run(self, progress: Progress | None = None) -> None:
        """Measure until all is measured or the budget is spent.

        Args:
            progress: called between calls with about how many seconds are left, at most, and how
                many settings have been measured.

        Raises:
            MotionError: positions leave the range of double.
            TreeFileError: a tree file is damaged.
        """
        self._begun = time.perf_counter()
        show = progress or (lambda _seconds, _count: None)
        planned = list(self._plan())
        self._unreached = dict.fromkeys(planned, "the budget ended before")
        if not self._ask_reference():
            return
        with no_collections():
            self._first_calls(planned, _FIRST_SHARE, show)
            self._take_turns(_EARLY_ROUNDS, _EARLY_SHARE, show)
            self._first_calls(self._crossed(), _CROSSED_SHARE, show)
            self._take_turns(_ROUNDS, 1.0, show)

    def result(self) -> Tradeoff:
        """Return what was measured.

        Raises:
            MotionError: not even the reference was asked; `run` was interrupted at once.
        """
        if self._reference is None:
            raise MotionError("tradeoff", "nothing was measured yet", "let it run longer")
        rows = [self._row(entry) for entry in self._entries.values()]
        front = front_of([(row.error, row.warm.median) for row in rows])
        return Tradeoff(
            reference=self._reference,
            reference_accuracy=self._reference_accuracy,
            duration=self.duration,
            rows=tuple(replace(row, on_front=on) for row, on in zip(rows, front, strict=True)),
            unreached=tuple(
                Unreached(self._trees.options(setting.build), setting.accuracy, why)
                for setting, why in self._unreached.items()
            ),
            budget=self._budget,
            seconds=time.perf_counter() - self._begun,
        )

    def _plan(self) -> Iterator[Setting]:
        trees = self._trees
        motions = [body.motion for body in trees.bodies]
        still = all(motion.is_at_rest for motion in motions)
        turns = not all(motion.goes_straight for motion in motions)
        duration = 0.0 if still else self.duration
        scale = Scale(duration, trees.size, turns, levels_of(trees.triangle_count))
        return plan(self._asked, scale, varies_trees=trees.can_vary)

    @property
    def _left(self) -> float:
        """How much of the budget is left, s."""
        return self._budget - (time.perf_counter() - self._begun)

    def _ask_reference(self) -> bool:
        """Ask for the answer that errors are measured against; return whether it is known."""
        # The default trees are built whatever the budget: without them there is no answer at all.
        built = self._trees.built(DEFAULT_BUILD, None)
        assert built is not None
        found, _seconds = self._timed(built, self._reference_accuracy, max(self._left, 0.0))
        self._reference = found
        if found.status is not Status.UNRESOLVED:
            self._judge = Judge(built.bodies, found, self._asked.clearance)
        return self.has_reference

    def _first_calls(self, settings: Iterable[Setting], share: float, show: Progress) -> None:
        """Build what a setting needs and ask it once, while a share of what is left lasts."""
        end = (1 - share) * self._left
        for setting in settings:
            left = self._left - end
            self._unreached[setting] = "the budget ended before"
            if left <= 0 or self._predicted(setting) > left:
                continue
            try:
                built = self._trees.built(setting.build, left)
                if built is None:
                    continue
                answer, seconds = self._timed(built, setting.accuracy, self._left - end)
            except MotionError as fault:  # more than an integrator can follow in so few steps
                self._unreached[setting] = str(fault)
                continue
            if _was_cut(answer, setting.accuracy, seconds):
                continue
            del self._unreached[setting]
            self._entries[setting] = _Entry(setting, built, answer, seconds)
            show(max(self._left, 0.0), len(self._entries))

    def _predicted(self, setting: Setting) -> float:
        """Return how long a setting should take at least: of samples, from what fewer took."""
        accuracy = setting.accuracy
        if accuracy.method != "sampled":
            return 0.0
        known = [
            entry.first * accuracy.steps / entry.setting.accuracy.steps
            for entry in self._entries.values()
            if entry.setting.accuracy.method == "sampled"
            and entry.setting.accuracy.integrator == accuracy.integrator
            and 256 <= entry.setting.accuracy.steps < accuracy.steps
        ]
        return 0.5 * known[-1] if known else 0.0

    def _take_turns(self, rounds: int, share: float, show: Progress) -> None:
        """Ask each setting once a round until all were asked so often.

        Args:
            rounds: how often; fewer where a setting is too slow for its fair part of the time.
            share: of the budget that is left: what this may take.
            show: as `progress` of `run`.
        """
        entries = list(self._entries.values())
        costs = [entry.timing.median for entry in entries]
        missing = [max(rounds - len(entry.times), 0) for entry in entries]
        most = fair_part([c * m for c, m in zip(costs, missing, strict=True)], share * self._left)
        turns = [int(min(m, most / c)) for c, m in zip(costs, missing, strict=True)]
        for turn in range(max(turns, default=0)):
            first = turn % len(entries)
            for index in (*range(first, len(entries)), *range(first)):
                if turn >= turns[index] or costs[index] > self._left:
                    continue
                entry = entries[index]
                _answer, seconds = self._timed(entry.built, entry.setting.accuracy, None)
                entry.times.append(seconds)
            left = sum(c * max(t - turn - 1, 0) for c, t in zip(costs, turns, strict=True))
            show(max(min(left, self._left), 0.0), len(entries))

    def _crossed(self) -> list[Setting]:
        """Return the fastest trees with the methods that are on the front of the default ones."""
        entries = [entry for entry in self._entries.values() if self._error(entry) is not None]
        base = self._entries.get(next(iter(self._entries), Setting(DEFAULT_BUILD, Accuracy())))
        if base is None:
            return []
        same = [e for e in entries if e.setting.accuracy == base.setting.accuracy]
        trees = sorted(same, key=lambda e: e.timing.median)
        builds = [e.setting.build for e in trees if e.setting.build != DEFAULT_BUILD][
            :_CROSSED_TREES
        ]
        own = [e for e in entries if e.setting.build == DEFAULT_BUILD]
        front = front_of([(self._error(e), e.timing.median) for e in own])
        ways = [e.setting.accuracy for e, on in zip(own, front, strict=True) if on]
        crossed = (Setting(build, way) for way in ways for build in builds)
        return [setting for setting in crossed if setting not in self._entries]

    def _error(self, entry: _Entry) -> float | None:
        return self._row(entry).error

    def _row(self, entry: _Entry) -> Trial:
        assert self._judge is not None
        judged = self._judge.judge(entry.answer)
        return Trial(
            build=self._trees.options(entry.setting.build),
            accuracy=entry.setting.accuracy,
            answer=entry.answer,
            **judged._asdict(),
            warm=entry.timing,
            build_seconds=entry.built.seconds,
            tree_bytes=entry.built.nbytes,
        )

    def _timed(
        self, built: Built, accuracy: Accuracy, limit: float | None
    ) -> tuple[FirstContact, float]:
        """Return an answer and the seconds it took; one that is cut short is unresolved."""
        start = time.perf_counter()
        if limit is None:
            answer = first_contact(*built.bodies, self.duration, accuracy)
        else:
            query = Query(*built.bodies, self.duration, accuracy)
            most = limit if accuracy.timeout is None else min(limit, accuracy.timeout)
            answer = query.advance(accuracy.max_iterations, most)
        return answer, time.perf_counter() - start


def _seconds(budget: float) -> float:
    try:
        return duration_of(budget, ())
    except MotionError as fault:
        raise MotionError("budget", fault.fault, fault.remedy) from fault


def _was_cut(answer: FirstContact, accuracy: Accuracy, seconds: float) -> bool:
    """Return whether the budget, and no limit of its own, ended a question."""
    if answer.status is not Status.UNRESOLVED:
        return False
    is_late = accuracy.timeout is not None and seconds >= accuracy.timeout
    return not is_late and answer.stats.pops < accuracy.max_iterations
