"""What all tests of the Python module share."""

import os
import pathlib
import subprocess

import pytest

SOURCE = pathlib.Path(__file__).parents[2]


@pytest.fixture(scope="session")
def cases():
    """The folder of the case files."""
    return SOURCE / "problems"


@pytest.fixture(scope="session")
def program():
    """Runs the program; gives what subprocess.run does, with its streams as text."""
    path = os.environ.get("ARCSLIP_PROGRAM", SOURCE / "build/release/bin/arcslip")

    def run(*arguments):
        return subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, check=False)

    return run
