"""The laws of the core as functions: calls, shapes and complaints. Their values are tested in tests/laws."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import trbdyn as trb
from trbdyn import InputError, laws


def test_names_and_signatures() -> None:
    assert len(laws.names()) > 20
    assert set(laws.names()) <= set(dir(laws))
    for name in laws.names():
        law = getattr(laws, name)
        assert law.__name__ == name
        assert inspect.signature(law).parameters
        for parameter in inspect.signature(law).parameters:
            assert parameter in law.__doc__
        assert len(law.__doc__.splitlines()[0]) > 10


def test_by_position_and_by_name() -> None:
    value = laws.traction_muraki_kimura(10.0, 1.0)
    assert isinstance(value, float)
    assert value == laws.traction_muraki_kimura(sigma=10.0, d=1.0) == laws.traction_muraki_kimura(d=1.0, sigma=10)
    assert value == pytest.approx(2.7735, abs=1e-4)
    assert trb.laws is laws


def test_arrays_broadcast() -> None:
    sigma, d = np.array([[1.0], [10.0], [100.0]]), np.array([10.0, 1.0])
    found = laws.traction_muraki_kimura(sigma, d)
    assert found.shape == (3, 2)
    assert found.dtype == np.float64
    for i in range(3):
        for k in range(2):
            assert found[i, k] == laws.traction_muraki_kimura(sigma[i, 0], d[k])
    assert laws.friction_boundary(np.zeros((0,)), 0.1, 22.28, 181.46).shape == (0,)
    assert laws.friction_boundary(np.zeros((2, 0, 3)), 0.1, 22.28, 181.46).shape == (2, 0, 3)
    backwards = np.linspace(0.0, 0.1, 7)[::-2]
    np.testing.assert_array_equal(
        laws.friction_boundary(backwards, 0.1, 22.28, 181.46),
        [laws.friction_boundary(s, 0.1, 22.28, 181.46) for s in backwards],
    )


def test_lists_and_integers_are_numbers() -> None:
    assert (
        laws.traction_muraki_kimura([1, 10], 10).tolist()
        == laws.traction_muraki_kimura(np.array([1.0, 10.0]), 10.0).tolist()
    )


def test_arguments_are_left_alone() -> None:
    sigma = np.array([1.0, 2.0])
    sigma.flags.writeable = False
    laws.traction_muraki_kimura(sigma, 1.0)
    assert sigma.tolist() == [1.0, 2.0]


@pytest.mark.parametrize("call", [{}, {"sigma": 1.0}, {"sigma": 1.0, "d": 1.0, "e": 1.0}, {"sigma": 1.0, "x": 1.0}])
def test_wrong_arguments_name_the_right_ones(call: dict[str, float]) -> None:
    with pytest.raises(TypeError, match=r"traction_muraki_kimura.*takes \(sigma, d\)"):
        laws.traction_muraki_kimura(**call)


@pytest.mark.parametrize("value", ["ten", None, object(), {"a": 1}, [[1.0], [1.0, 2.0]]])
def test_what_is_no_number(value: object) -> None:
    with pytest.raises(InputError, match="must be numbers"):
        laws.traction_muraki_kimura(value, 1.0)


def test_shapes_that_do_not_fit() -> None:
    with pytest.raises(InputError, match="broadcast"):
        laws.traction_muraki_kimura(np.zeros(2), np.zeros(3))


def test_an_unknown_law_lists_the_known() -> None:
    with pytest.raises(AttributeError, match="friction_boundary"):
        _ = laws.friction_of_ghosts


def test_nan_goes_through() -> None:
    """No law makes a number of what is none, whichever argument it is."""
    made = []
    for name in laws.names():
        law = getattr(laws, name)
        parameters = list(inspect.signature(law).parameters)
        for place, parameter in enumerate(parameters):
            arguments = [np.array([0.3, np.nan]) if k == place else 0.7 for k in range(len(parameters))]
            if not np.isnan(law(*arguments)[1]):
                made.append(f"{name}({parameter})")
    assert not made


def test_docstrings_name_every_argument_with_its_unit() -> None:
    """And nothing is described that no law takes."""
    import doctest

    from trbdyn.laws.texts import ARGUMENTS, EXAMPLES, OF_ONE_LAW

    taken = set()
    for name in laws.names():
        law = getattr(laws, name)
        for parameter in inspect.signature(law).parameters:
            line = next(line for line in law.__doc__.split(f"{parameter} : array_like\n")[1].splitlines())
            assert len(line.split()) >= 3, (name, parameter)
            assert line.rstrip().endswith(")."), (name, parameter)
            taken.add((name, parameter))
        parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(verbose=False)
        runner.run(parser.get_doctest(law.__doc__, {}, name, None, 0))
        assert runner.failures == 0, name
        assert (runner.tries > 0) == (name in EXAMPLES)
    assert set(OF_ONE_LAW) <= taken
    assert set(ARGUMENTS) == {parameter for name, parameter in taken if (name, parameter) not in OF_ONE_LAW}


def test_help_of_inputs_is_a_page_or_two() -> None:
    import pydoc

    for kind in (trb.Scene, trb.Effects, trb.Bearing, trb.Lubricant, trb.Start, trb.RunOptions):
        text = pydoc.plain(pydoc.render_doc(kind))
        assert len(text.splitlines()) < 230, kind
        assert max(map(len, text.splitlines())) < 900, kind
        assert "replace(self" in text
        assert all(name in text for name in kind.model_fields)
        assert {"replace", "to_dict", "fingerprint", *kind.model_fields} <= set(dir(kind))
        assert "model_dump" not in text
