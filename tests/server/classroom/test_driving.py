"""Who drives a bench: a lease with a clock of its own, and no time that passes."""

from __future__ import annotations

from typing import Any

import pytest

from server.classroom.access import Need
from server.classroom.driving import Driving
from server.errors import ApiError
from server.security.person import TEACHER, Person

BENCH = "b1"
ADA, BEN = Person("ada", "Ada", "student", "c"), Person("ben", "Ben", "student", "c")
LINK = Person("w", "watcher", "watcher")


class Group:
    """Who may drive a bench, the pages, and what came of it."""

    def __init__(self, owner: Person | None = None) -> None:
        self._owner, self.loans = owner, dict[str, str]()
        self.now, self.asked, self.called = 100.0, list[str](), list[str]()
        self.said, self.lost = list[str](), list[str]()
        self.driving = Driving(
            self,  # type: ignore[arg-type]
            self,
            lambda _bench, person, text: self.said.append(f"{person.name} {text}"),
            lambda _bench, why: self.lost.append(why),
            lambda: self.now,
        )

    def owner(self, _bench: str) -> Person | None:
        return self._owner

    def may(self, person: Person, need: Need, bench: str) -> bool:
        assert need is Need.DRIVE
        return person.is_teacher or person is self._owner or self.is_lent(person, bench)

    def is_lent(self, person: Person, bench: str) -> bool:
        return self.loans.get(person.id) == bench

    def lend(self, person: Person, bench: str) -> None:
        self.loans[person.id] = bench

    def end_loan(self, person: Person) -> None:
        self.loans.pop(person.id)

    def students(self) -> list[Person]:
        return [ADA, BEN]

    def ask(self, _bench: str, person: Person) -> None:
        self.asked.append(person.id)

    def tell(self, bench: str) -> None:
        pass

    def call(self, people: list[Person]) -> None:
        self.called += [person.id for person in people]

    def come(self, *people: Person) -> None:
        for person in people:
            self.driving.come(BENCH, person)

    def go(self, person: Person) -> None:
        self.driving.go(BENCH, person)

    def wait(self, seconds: float, *heard: Person) -> None:
        """Let time pass, looked at as often as the service does; some answer all the time."""
        for _ in range(round(seconds * 4)):
            self.now += 0.25
            for person in heard:
                self.driving.heard(BENCH, person)
            self.driving.look()

    def drives(self) -> str | None:
        """Who drives; nothing while it needs no driver."""
        company = self.driving.company(BENCH)
        if company is None or not company.is_leased:
            return None
        return company.driver.name if company.driver is not None else "nobody"

    def refused(self, person: Person) -> bool:
        try:
            self.driving.check(BENCH, person)
        except ApiError as error:
            assert (error.status_code, error.body.code) == (409, "driving")
            return True
        return False


def test_somebody_alone_feels_nothing_with_any_number_of_pages() -> None:
    group = Group()
    group.come(TEACHER, TEACHER, TEACHER)
    group.wait(30)
    assert group.driving.company(BENCH) is None and not group.refused(TEACHER)
    assert group.asked == [] and group.said == [] and group.lost == []


def test_links_to_watch_make_company_but_no_lease() -> None:
    group = Group()
    group.come(TEACHER, LINK, LINK)
    company = group.driving.company(BENCH)
    assert company is not None and company.links == 2 and not company.is_leased
    assert [one.name for one in company.drivers] == ["teacher"]
    assert not group.refused(TEACHER)


def test_a_student_drives_the_own_bench_whoever_was_there_first() -> None:
    group = Group(ADA)
    group.come(TEACHER, ADA)
    assert group.drives() == "Ada" and group.refused(TEACHER) and not group.refused(ADA)
    group.wait(1, ADA)
    assert set(group.asked) == {"ada"}


def test_it_is_asked_for_handed_over_and_taken_back() -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.driving.ask(BENCH, TEACHER)
    company = group.driving.company(BENCH)
    assert company is not None and [one.id for one in company.asking] == ["teacher"]
    group.driving.hand_over(BENCH, ADA, "teacher")
    assert group.drives() == "teacher" and group.refused(ADA)
    group.driving.take(BENCH, ADA)  # she lent it
    assert group.drives() == "Ada"
    group.driving.take(BENCH, TEACHER)
    assert group.drives() == "teacher"
    with pytest.raises(ApiError, match="the teacher drives"):
        group.driving.take(BENCH, ADA)  # he took it; it has to be asked for
    group.driving.ask(BENCH, ADA)
    group.driving.refuse(BENCH, TEACHER, "ada")
    assert group.drives() == "teacher"
    with pytest.raises(ApiError, match="has asked"):
        group.driving.refuse(BENCH, TEACHER, "ada")
    with pytest.raises(ApiError, match="the teacher drives"):
        group.driving.hand_over(BENCH, ADA, "ada")
    assert group.said[:3] == [
        "teacher came to the bench",
        "teacher asked Ada for the bench",
        "teacher was handed the bench by Ada",
    ]


@pytest.mark.parametrize("silent", [True, False], ids=["silent", "gone"])
def test_a_driver_who_is_not_heard_for_5_s_drives_no_more(silent: bool) -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.wait(3, ADA)
    if not silent:
        group.go(ADA)
    group.wait(4.75)
    assert group.refused(TEACHER) and group.lost == []
    group.wait(0.25)
    assert not group.refused(TEACHER)
    assert group.lost == ["Ada, who drove, has not been heard for 5 s"]
    # a present person drives at the next command, and the other person is refused; alone there is no effect
    assert group.refused(ADA) == silent and group.drives() == ("teacher" if silent else None)


def test_a_page_that_is_loaded_again_keeps_the_lease() -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.driving.take(BENCH, TEACHER)
    group.go(ADA)
    group.wait(2, TEACHER)
    group.come(ADA)
    group.go(TEACHER)
    group.wait(2)
    group.come(TEACHER)
    group.wait(20, TEACHER, ADA)
    assert group.drives() == "teacher" and group.lost == []
    assert "Ada left the bench" not in group.said


def test_whoever_is_alone_again_for_5_s_needs_no_lease() -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.go(TEACHER)
    group.wait(6, ADA)
    assert group.driving.company(BENCH) is None and group.said[-1] == "teacher left the bench"
    assert group.lost == []


def test_a_bench_that_nobody_drives_is_had_by_who_does_something() -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.driving.leave(BENCH, ADA)
    assert group.drives() == "nobody"
    group.driving.check(BENCH, TEACHER)
    assert group.drives() == "teacher" and group.refused(ADA)


def test_a_command_of_a_program_counts_as_the_teacher() -> None:
    group = Group(ADA)
    group.come(ADA)
    assert not group.refused(TEACHER) and not group.refused(ADA)  # one page is open
    group.driving.take(BENCH, TEACHER)
    group.wait(4)
    assert group.refused(ADA)
    group.driving.check(BENCH, TEACHER)
    group.wait(4)
    assert group.refused(ADA)
    group.wait(2)
    assert not group.refused(ADA)


def test_the_teacher_lends_the_own_bench_until_it_is_taken_back() -> None:
    group = Group()
    group.come(TEACHER)
    group.driving.hand_over(BENCH, TEACHER, "ben")
    assert group.called == ["ben"] and group.loans == {"ben": BENCH} and group.refused(TEACHER)
    group.wait(8)  # a phone takes its time
    group.come(BEN)
    group.wait(3, BEN)
    assert group.drives() == "Ben"
    group.driving.take(BENCH, TEACHER)
    assert group.loans == {} and group.called == ["ben", "ben"]


@pytest.mark.parametrize("how", ["leaves", "goes", "never comes"])
def test_a_loan_ends_with_whoever_had_it(how: str) -> None:
    group = Group()
    group.come(TEACHER)
    group.driving.hand_over(BENCH, TEACHER, "ben")
    if how != "never comes":
        group.come(BEN)
        group.go(TEACHER)  # who drives a bench that was lent drives it alone too
        group.wait(20, BEN)
        assert group.loans == {"ben": BENCH}
    if how == "leaves":
        group.driving.leave(BENCH, BEN)
    elif how == "goes":
        group.go(BEN)
    group.wait(16)
    assert group.loans == {} and not group.refused(TEACHER)


def test_what_cannot_be_handed_over_is_said() -> None:
    group = Group(ADA)
    group.come(ADA)
    for person, whom, words in (
        (TEACHER, "ben", "the bench of a student"),
        (TEACHER, "nobody", "no student"),
        (ADA, "ben", "no person of this id is here"),
        (ADA, "ada", "needs no driver"),
    ):
        with pytest.raises(ApiError, match=words):
            group.driving.hand_over(BENCH, person, whom)
    assert group.loans == {}


def test_a_server_that_stood_still_takes_the_bench_from_nobody() -> None:
    group = Group(ADA)
    group.come(ADA, TEACHER)
    group.wait(1, ADA)
    group.now += 60.0
    group.driving.look()
    assert group.drives() == "Ada"
    group.wait(5.5)
    assert group.drives() == "nobody"


def test_many_who_look_on_are_told_in_few_names() -> None:
    group = Group()
    group.come(TEACHER, *(Person(f"s{n}", f"S{n}", "student", "c") for n in range(60)))
    company: Any = group.driving.company(BENCH)
    assert len(company.watching) == 12 and company.more_watching == 48 and not company.is_leased
