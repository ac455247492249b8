"""Some thousand random calls and damaged files: only results and errors of the package come out."""

from __future__ import annotations

import pytest

from api import fuzzing


@pytest.mark.parametrize("name", fuzzing.CALLS)
def test_the_calls_that_are_spoiled_are_right(name: str) -> None:
    function, arguments = fuzzing.CALLS[name]
    function(**arguments)


def test_only_errors_of_the_package_come_out_of_spoiled_calls() -> None:
    assert [str(escape) for escape in fuzzing.escapes(4000, seed=20)] == []


def test_only_errors_of_the_package_come_out_of_damaged_files() -> None:
    assert [str(escape) for escape in fuzzing.file_escapes(1500, seed=21)] == []
