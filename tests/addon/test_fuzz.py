"""Hostile curve objects and batches: a few of what ``python -m benchmarks.fuzz_blender`` lets in."""

from pathlib import Path
from random import Random

import pytest

from benchmarks.fuzz_blender import doors
from benchmarks.fuzz_run import attempt, scratch

#: Inputs for each door.
FEW = {"curves": 200, "batch": 100}


@pytest.mark.parametrize("name", FEW)
def test_what_is_let_in_is_used_or_refused(extension, name):
    door = doors(extension)[name]
    with scratch() as folder:
        for seed in range(FEW[name]):
            attempt(door, door.make(Random(seed)), Path(folder))
