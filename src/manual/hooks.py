"""What mkdocs does besides: pages link to files of the repository, which the site carries with it, formulas are drawn
by KaTeX, of which it has a copy, so that it opens without a network, and two pages are made of docstrings."""

import os
import pathlib
import re
import shutil
import sys

from mkdocs.structure.files import File

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
KATEX = pathlib.Path("/usr/share/javascript/katex")
TO_REPOSITORY = re.compile(r"(\]\()((?:\.\./){3})([^)#\s]+)")
FORMULAS = """document.querySelectorAll(".arithmatex").forEach(function (place) {
  var text = place.textContent, display = text.startsWith("\\\\[");
  katex.render(text.slice(2, -2), place, {displayMode: display, throwOnError: true});
});
"""
HEADERS = """# C++ headers

What every public header says it declares, made by Doxygen of the docstrings: [all of it](cxx/index.html),
[classes](cxx/annotated.html), [files](cxx/files.html). How to begin is told in [Use from C++](cpp.md).
"""

sys.path.insert(0, str(HERE))


def carried(target):
    """The name in the site of a file that a page links to; browsers show all but pictures as text."""
    is_picture = target.endswith((".png", ".svg"))
    return f"files/{target.rstrip('/')}" + ("" if is_picture else ".txt")


def on_page_markdown(markdown, page, config, files):
    """Links to the repository become links to what the site carries of it."""
    return TO_REPOSITORY.sub(lambda match: f"{match[1]}{carried(match[3])}", markdown)


def carry(pages, work):
    """Copies what the pages link to; of a folder there is a list of what it holds."""
    for target in {match[3] for page in pages for match in TO_REPOSITORY.finditer(page.read_text())}:
        place = work / carried(target)
        place.parent.mkdir(parents=True, exist_ok=True)
        if (SOURCE / target).is_dir():
            place.write_text("".join(f"{name}\n" for name in sorted(os.listdir(SOURCE / target))))
        else:
            shutil.copyfile(SOURCE / target, place)


def on_files(files, config):
    """Adds what is not among the pages, from a folder beside the site, in which Doxygen has left its own."""
    from module_page import module_page

    work = pathlib.Path(config["site_dir"]).resolve().parent / "added"
    carry(pathlib.Path(config["docs_dir"]).glob("*.md"), work)
    shutil.copytree(KATEX / "fonts", work / "katex/fonts", dirs_exist_ok=True)
    for name in ("katex.min.css", "katex.min.js"):
        shutil.copyfile(KATEX / name, work / "katex" / name)
    (work / "katex/formulas.js").write_text(FORMULAS)
    (work / "headers.md").write_text(HEADERS)
    (work / "module.md").write_text(module_page())
    for path in sorted(work.rglob("*")):
        if path.is_file():
            name = str(path.relative_to(work))
            files.append(File(name, str(work), config["site_dir"], config["use_directory_urls"]))
    return files
