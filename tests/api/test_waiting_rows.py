"""Records that wait for the result file: none is lost, doubled or put out of order, and only whole blocks are given away."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from trbdyn.results.waiting_rows import WaitingRows


@given(
    block=st.integers(1, 7),
    moves=st.lists(st.tuples(st.integers(0, 12), st.sampled_from(["wait", "blocks", "all"])), max_size=20),
)
def test_rows_come_out_as_they_went_in(block: int, moves: list[tuple[int, str]]) -> None:
    waiting, came, given_away = WaitingRows(block), 0, [np.empty((0, 2))]
    for count, move in moves:
        if count:
            numbers = np.arange(came, came + count, dtype=float)
            waiting.append(np.column_stack((numbers, -numbers)))
            came += count
        if move != "wait":
            earlier = sum(map(len, given_away))
            given_away += waiting.take(whole_blocks=move == "blocks")
            gone = sum(map(len, given_away))
            if move == "all":
                assert gone == came
            else:
                # what is kept back is less than a block, and what is given away ends with a block
                assert came - gone < block
                assert gone % block == 0 or gone == earlier
        assert waiting.nbytes == 16 * (came - sum(map(len, given_away)))
    given_away += waiting.take()
    np.testing.assert_array_equal(np.concatenate(given_away)[:, 0], np.arange(came))


def test_time_counts_from_what_was_given_away() -> None:
    waiting = WaitingRows(4)
    waiting.append(np.zeros((3, 1)))
    before = waiting.seconds
    assert waiting.take(whole_blocks=True) == []
    assert waiting.seconds >= before
    waiting.append(np.zeros((1, 1)))
    assert len(waiting.take(whole_blocks=True)) == 2
    assert waiting.seconds < before + 1.0
