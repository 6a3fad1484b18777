"""What all tests of the Python module share."""

import os
import pathlib
import signal
import subprocess
import sys

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


@pytest.fixture(scope="session")
def interrupted():
    """What a script prints that says "ready" and is interrupted at its work two seconds later."""

    def run(script):
        with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as child:
            assert child.stdout.readline() == "ready\n"
            with pytest.raises(subprocess.TimeoutExpired):
                child.wait(2)
            child.send_signal(signal.SIGINT)
            out, _ = child.communicate(timeout=20)
        return out

    return run
