"""`AllContacts`: the contacts of all pairs of triangles of a scene, in order of time."""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING, NamedTuple

from obbcli.answers.counts import Counts
from obbcli.answers.status import Status
from obbcli.errors import MotionError, UnresolvedError
from obbcli.questions.contacts import search_contacts
from obbcli.questions.describe import unresolved
from obbcli.questions.pair_question import PairQuestion, time_tolerance
from obbcli.questions.search import Search
from obbcli.scene.candidates import earliest
from obbcli.scene.contact_stream import ContactStream
from obbcli.scene.first_contacts import FirstContacts
from obbcli.scene.results import SceneContact, SceneStats

if TYPE_CHECKING:
    from collections.abc import Iterator

    from obbcli.answers.contact import Contact
    from obbcli.scene.pairs import ScenePairs


class _Listing(NamedTuple):
    """The contacts of two bodies. No two are of the same bodies.

    Attributes:
        time: s; nothing of it comes before.
        a: place of the first body in the scene.
        b: place of the second.
        next: what comes next; None where that is not known yet.
        rest: what comes then; None where nothing is known of it.
        search: the limits of the list.
    """

    time: float
    a: int
    b: int
    next: SceneContact | None
    rest: Iterator[Contact] | None
    search: Search


class AllContacts(ContactStream):
    """Contacts of a scene, earliest first, one a pair of triangles that touches.

    Made by `Scene.contacts`. Two bodies are listed when it is known that they touch next. Where a
    limit ends their list, `unresolved` stands at the time up to which it is whole.

    Args:
        asked: bodies and pairs.
        limit: at most so many contacts. None: all.
    """

    def __init__(self, asked: ScenePairs, limit: int | None) -> None:
        if asked.accuracy.method == "sampled":
            fault = "knows the first contact alone"
            raise MotionError("method='sampled'", fault, "use the certified method")
        super().__init__(asked)
        self._firsts = FirstContacts(asked, first=False, is_eager=False)
        self._listings: list[_Listing] = []
        self._left = limit
        self._tolerance = time_tolerance(asked.accuracy, asked.duration)
        self._counts = Counts()

    @property
    def time(self) -> float:
        """Up to when all is known and was yielded, s; the duration when nothing is left."""
        firsts = self._next_first()
        return min(firsts, self._listings[0].time) if self._listings else firsts

    def _next_first(self) -> float:
        """Return what no contact of bodies that are not listed yet comes before, s."""
        # The brackets of later pairs of triangles may begin before that of the first contact.
        known = self._firsts.time
        return known if self._firsts.is_finished else earliest(known, self._tolerance)

    @property
    def is_finished(self) -> bool:
        """Whether all that was asked for was yielded."""
        return self._left == 0 or (self._firsts.is_finished and not self._listings)

    @property
    def stats(self) -> SceneStats:
        """What became of the pairs so far, and what it took."""
        stats = self._firsts.stats
        boxes, triangles, exact, pops, images = self._counts
        return stats._replace(
            box_tests=stats.box_tests + boxes,
            triangle_tests=stats.triangle_tests + triangles,
            exact_triangle_tests=stats.exact_triangle_tests + exact,
            pops=stats.pops + pops,
            image_tests=stats.image_tests + images,
        )

    def stop(self) -> None:
        """Give up: of all that is not known yet it comes next up to when it is."""
        self._firsts.stop()

    def advance(self) -> SceneContact | None:
        """Go on by a step; return the next contact where that finds it.

        Raises:
            ObbError: as `__next__`.
        """
        if self.is_finished:
            return None
        is_first = not self._listings or self._next_first() <= self._listings[0].time
        if is_first and not self._firsts.is_finished:
            found = self._firsts.advance()
            if found is None or found.status is Status.UNRESOLVED:
                return found
            self._begin(found)
            return None
        return self._advance_list(self._listings[0])

    def _advance_list(self, listing: _Listing) -> SceneContact | None:
        """Return the next contact of two bodies, or look for it."""
        if listing.next is not None:
            # The contact is handed out before the next is looked for: an interrupt loses none.
            self._left = None if self._left is None else self._left - 1
            if listing.rest is None:
                heapq.heappop(self._listings)
            else:
                heapq.heapreplace(self._listings, listing._replace(next=None))
            return listing.next
        if self._firsts.is_late():
            self._end(listing, listing.time)
        else:
            with self.asked.timed("query"):
                self._go_on(listing)
        return None

    def _begin(self, first: SceneContact) -> None:
        """Begin to list the contacts of two bodies that are known to touch."""
        a, b = self.asked.pair_of(first)
        duration, accuracy = self.asked.duration, self.asked.accuracy
        search = Search(accuracy.max_iterations, self._firsts.seconds_left())
        pair = PairQuestion.of(*self.asked.bodies_of(a, b), duration, accuracy)
        rest = search_contacts(pair, search)
        low = earliest(first.time, self._tolerance)
        heapq.heappush(self._listings, _Listing(low, a, b, None, rest, search))

    def _go_on(self, listing: _Listing) -> None:
        """Find the next contact of two bodies."""
        assert listing.rest is not None
        before = listing.search.counts
        try:
            contact = next(listing.rest, None)
        except UnresolvedError as limit:
            self._end(listing, limit.time or 0.0)
            return
        except BaseException:
            # An interrupted generator ends: without this entry its list would seem complete.
            self._end(listing, listing.time)
            raise
        finally:
            self._counts += listing.search.counts - before
        if contact is None:
            heapq.heappop(self._listings)
            return
        assert contact.time is not None
        found = SceneContact(*self.asked.names(listing.a, listing.b), contact)
        heapq.heapreplace(self._listings, listing._replace(time=contact.time, next=found))

    def _end(self, listing: _Listing, low: float) -> None:
        """Say up to when a list is whole that goes no further."""
        names = self.asked.names(listing.a, listing.b)
        end = SceneContact(*names, unresolved(max(low, listing.time)))
        heapq.heapreplace(self._listings, listing._replace(time=end.time, next=end, rest=None))
