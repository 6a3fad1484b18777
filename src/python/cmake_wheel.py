"""Builds the wheel for pip (PEP 517): cmake compiles and installs into a folder, which is zipped with its metadata."""

import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import tempfile
import tomllib
import zipfile

HERE = pathlib.Path(__file__).parent
SOURCE = HERE.parents[1]
BUILD = SOURCE / "build" / "wheel"


def _names():
    """The wheel's name up to its tag, and its tag."""
    version = re.search(r"VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text().split("project(")[1]).group(1)
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = re.sub(r"[-.]", "_", sysconfig.get_platform())
    return f"arcslip-{version}", f"{python}-{python}-{platform}"


def _metadata():
    project = tomllib.loads((HERE / "pyproject.toml").read_text())["project"]
    name, tag = _names()
    lines = ["Metadata-Version: 2.1", f"Name: {project['name']}", f"Version: {name.split('-')[1]}"]
    lines += [f"Summary: {project['description']}", f"Requires-Python: {project['requires-python']}"]
    lines += [f"Requires-Dist: {package}" for package in project["dependencies"]]
    for extra, packages in project["optional-dependencies"].items():
        lines += [f"Provides-Extra: {extra}"]
        lines += [f'Requires-Dist: {package}; extra == "{extra}"' for package in packages]
    wheel = ["Wheel-Version: 1.0", "Generator: arcslip", "Root-Is-Purelib: false", f"Tag: {tag}"]
    return {"METADATA": "\n".join(lines) + "\n", "WHEEL": "\n".join(wheel) + "\n"}


def _install(folder):
    configure = [
        *("cmake", "-S", SOURCE, "-B", BUILD, "-DCMAKE_BUILD_TYPE=Release", "-DBUILD_TESTING=OFF"),
        *("-DARCSLIP_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}", "-DARCSLIP_PYTHON_DIR=."),
    ]
    subprocess.run(configure, check=True)
    jobs = str(os.cpu_count() or 1)
    subprocess.run(["cmake", "--build", BUILD, "--target", "arcslip_python", "--parallel", jobs], check=True)
    subprocess.run(["cmake", "--install", BUILD, "--component", "python", "--prefix", folder], check=True)


def prepare_metadata_for_build_wheel(metadata_directory, config_settings=None):
    """Hook of PEP 517."""
    folder = pathlib.Path(metadata_directory) / f"{_names()[0]}.dist-info"
    folder.mkdir(parents=True)
    for name, text in _metadata().items():
        (folder / name).write_text(text)
    return folder.name


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    """Hook of PEP 517."""
    name, tag = _names()
    with tempfile.TemporaryDirectory() as folder:
        _install(folder)
        files = {str(p.relative_to(folder)): p.read_bytes() for p in sorted(pathlib.Path(folder).rglob("*.*"))}
    for file, text in _metadata().items():
        files[f"{name}.dist-info/{file}"] = text.encode()
    record = ""
    for file, content in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
        record += f"{file},sha256={digest},{len(content)}\n"
    files[f"{name}.dist-info/RECORD"] = (record + f"{name}.dist-info/RECORD,,\n").encode()
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / f"{name}-{tag}.whl", "w", zipfile.ZIP_DEFLATED) as wheel:
        for file, content in files.items():
            wheel.writestr(file, content)
    return f"{name}-{tag}.whl"
