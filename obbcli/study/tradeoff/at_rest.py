"""What a tolerance costs of a question about bodies at rest: distance, or overlap.

Every setting's brackets are held against those of the narrowest: two that do not overlap contradict
each other, and one of them is no proof.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

from obbcli.accuracy import Accuracy
from obbcli.answers.overlap import Overlap
from obbcli.errors import MotionError
from obbcli.questions.distance import measure
from obbcli.questions.overlap.asked import Asked, refuse_other_accuracy
from obbcli.questions.overlap.band import pair_size
from obbcli.questions.overlap.overlap import overlap_of
from obbcli.questions.pair_question import PairQuestion, duration_of
from obbcli.study.tradeoff.rest_judge import brackets, contradictions
from obbcli.study.tradeoff.taking_turns import no_collections
from obbcli.study.tradeoff.trials import Timing, front_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from obbcli.answers.distance import Distance
    from obbcli.motion.body import Body, Shape
    from obbcli.study.asks import RestAsk
    from obbcli.study.tradeoff.measuring import Progress

# The narrowest last: it is what the others are held against, and the dearest.
_TOLERANCES = (0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3)
# Of the pair's size; None: as close as doubles allow.
_DISTANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, None)
_DEPTHS = (2, 4, 6, 8, 12, 16)
# Of the depth that was found: decisions just beside it, and further off.
_SHARES = (0.5, 0.9, 1.1, 2.0)
_ROUNDS = 9


class RestSetting(NamedTuple):
    """How a question is asked.

    Attributes:
        words: what is told of it: the options that ask so.
        accuracy: its limits.
        asked: about an overlap.
    """

    words: tuple[str, ...]
    accuracy: Accuracy
    asked: Asked = Asked()


@dataclass(frozen=True, kw_only=True)
class RestTrial:
    """One setting, measured.

    Attributes:
        words: the options that ask so; none of the defaults.
        relation: of an overlap; None of a distance.
        bounds: brackets by their names, mesh units; hi is None where it is not known.
        width: mesh units; the widest of the brackets of lengths. None where one has no end.
        claims_checked: how many brackets and verdicts were held against the narrowest setting's.
        faults: those that contradict it. There should be none, ever.
        warm: s a call.
        on_front: whether no other setting was as narrow and as fast and better in one.
    """

    words: tuple[str, ...]
    relation: str | None
    bounds: Mapping[str, tuple[float, float | None]]
    width: float | None
    claims_checked: int
    faults: tuple[str, ...]
    warm: Timing
    on_front: bool = False


@dataclass(frozen=True, kw_only=True)
class RestTradeoff:
    """What a tolerance costs, measured on two bodies at rest.

    Attributes:
        ask: `"distance"` or `"overlap"`.
        reference: the answer of the narrowest setting.
        rows: the settings that were measured, the narrowest among them.
        unreached: the options of those that the budget did not reach.
        budget: s allowed.
        seconds: s taken.
    """

    ask: RestAsk
    reference: Distance | Overlap
    rows: tuple[RestTrial, ...]
    unreached: tuple[tuple[str, ...], ...]
    budget: float
    seconds: float

    @property
    def faulty(self) -> tuple[RestTrial, ...]:
        """The rows that contradict the narrowest. There should be none, ever."""
        return tuple(row for row in self.rows if row.faults)


class RestStudy:
    """The trade of one question about bodies at rest; `run` may be interrupted.

    Args:
        a: a `Body`, an `ObbTree`, a `Mesh`, a `Part`, or the path of a mesh or tree file.
        b: the other shape, of the same kinds.
        accuracy: the limits that all settings share. None: the defaults.
        ask: which question.
        budget: s that the study may take; the narrowest answer is not cut short but by
            `accuracy`.

    Raises:
        MotionError: the budget is negative or not finite, or a field of `accuracy` says nothing
            about the question.
        ObbError: as the question says.
    """

    def __init__(
        self,
        a: Body | Shape,
        b: Body | Shape,
        accuracy: Accuracy | None = None,
        *,
        ask: RestAsk,
        budget: float = 60.0,
    ) -> None:
        shared = Accuracy() if accuracy is None else accuracy
        if ask == "overlap":
            refuse_other_accuracy(shared)
        try:
            self._budget = duration_of(budget, ())
        except MotionError as fault:
            raise MotionError("budget", fault.fault, fault.remedy) from fault
        self._ask_word = ask
        self._shared = shared
        self._pair = PairQuestion.of(a, b, 0.0, shared)
        self._begun = time.perf_counter()
        self._reference: Distance | Overlap | None = None
        self._answers: dict[RestSetting, Distance | Overlap] = {}
        self._times: dict[RestSetting, list[float]] = {}
        self._planned: list[RestSetting] = []

    @property
    def has_reference(self) -> bool:
        """Whether the answer of the narrowest setting is known."""
        return self._reference is not None

    @property
    def accuracy(self) -> Accuracy:
        """What all settings share."""
        return self._shared

    @property
    def bodies(self) -> tuple[Body, Body]:
        """A and B."""
        return self._pair.bodies

    def run(self, progress: Progress | None = None) -> None:
        """Measure until all is measured or the budget is spent.

        Args:
            progress: called between calls with about how many seconds are left, and how many
                settings have been measured.
        """
        show = progress or (lambda _seconds, _count: None)
        *others, narrowest = self._grid()
        with no_collections():
            self._reference = self._ask(narrowest)
            self._planned = [narrowest, *others, *self._decisions()]
            for _ in range(_ROUNDS + 1):  # the first call warms up
                for setting in self._planned:
                    left = self._budget - (time.perf_counter() - self._begun)
                    if left > self._cost(setting):
                        self._ask(setting)
                        show(max(left, 0.0), len(self._answers))

    def result(self) -> RestTradeoff:
        """Return what was measured.

        Raises:
            MotionError: `run` was interrupted before the first answer.
        """
        if self._reference is None:
            raise MotionError("tradeoff", "nothing was measured yet", "let it run longer")
        rows = [self._row(setting) for setting in self._answers]
        front = front_of([(row.width, row.warm.median) for row in rows])
        return RestTradeoff(
            ask=self._ask_word,
            reference=self._reference,
            rows=tuple(replace(row, on_front=on) for row, on in zip(rows, front, strict=True)),
            unreached=tuple(one.words for one in self._planned if one not in self._answers),
            budget=self._budget,
            seconds=time.perf_counter() - self._begun,
        )

    def _grid(self) -> Iterator[RestSetting]:
        """Yield the settings, the narrowest last."""
        if self._ask_word == "overlap":
            for tolerance in _TOLERANCES:
                words = ("--tolerance", f"{tolerance:g}")
                yield RestSetting(words, self._shared, Asked(tolerance=tolerance))
            return
        for depth in _DEPTHS:
            accuracy = replace(self._shared, max_depth_a=depth, max_depth_b=depth)
            yield RestSetting(("--max-depth", str(depth)), accuracy)
        for share in _DISTANCES:
            if share is None:
                yield RestSetting((), replace(self._shared, distance_tolerance=None))
                continue
            near = float(f"{share * pair_size(self._pair):.0e}")
            accuracy = replace(self._shared, distance_tolerance=near)
            yield RestSetting(("--distance-tolerance", f"{near:g}"), accuracy)

    def _decisions(self) -> Iterator[RestSetting]:
        """Yield whether a depth exceeds numbers beside the one that was found."""
        found = self._reference
        if not isinstance(found, Overlap) or found.thickness is None:
            return
        deepest = found.thickness.bounds[0]
        for share in _SHARES if deepest > 0 else ():
            limit = float(f"{share * deepest:.3g}")
            asked = Asked.of(deeper_than=limit)
            yield RestSetting(("--deeper-than", f"{limit:g}"), self._shared, asked)

    def _cost(self, setting: RestSetting) -> float:
        return min(self._times.get(setting, [0.0]))

    def _ask(self, setting: RestSetting) -> Distance | Overlap:
        """Ask with a setting, and keep the answer and the time that it took."""
        pair = self._pair._replace(accuracy=setting.accuracy)
        start = time.perf_counter()
        if self._ask_word == "overlap":
            answer: Distance | Overlap = overlap_of(pair, setting.asked)
        else:
            answer = measure(pair)[0]
        self._times.setdefault(setting, []).append(time.perf_counter() - start)
        self._answers.setdefault(setting, answer)
        return answer

    def _row(self, setting: RestSetting) -> RestTrial:
        answer, (first, *times) = self._answers[setting], self._times[setting]
        assert self._reference is not None
        checked, faults = contradictions(answer, setting.asked, self._reference)
        bounds = brackets(answer)
        widths = [high - low for name, (low, high) in bounds.items() if name != "volume"]
        # A decision tells no value that could be narrow.
        width = None if setting.asked.deeper_than is not None else max(widths, default=math.inf)
        return RestTrial(
            words=setting.words,
            relation=answer.relation if isinstance(answer, Overlap) else None,
            bounds={
                name: (low, high if high < math.inf else None)
                for name, (low, high) in bounds.items()
            },
            width=None if width == math.inf else width,
            claims_checked=checked,
            faults=tuple(faults),
            warm=Timing.of(times, first),
        )
