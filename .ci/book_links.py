"""Preprocessor of the book: links of pages that lead out of docs, to code or to README.md, go to the forge.

mdBook gives the book as JSON on the standard input and takes it back from the standard output.
"""

import json
import posixpath
import re
import sys

LINK = re.compile(r"(\]\()([^)\s]+)(\))")


def outside(page: str, target: str) -> str | None:
    """The path from the top of the repository, if a link of this page of docs leads out of docs."""
    if "://" in target or target.startswith("#"):
        return None
    path, hash_mark, anchor = target.partition("#")
    place = posixpath.normpath(posixpath.join("docs", posixpath.dirname(page), path))
    # mdBook takes every file of docs along, but shows no folder.
    is_file = place.startswith("docs/") and "." in posixpath.basename(place)
    return None if is_file else place + hash_mark + anchor


def rewritten(page: str, text: str, repository: str) -> str:
    """A page's text with its links out of docs on the forge."""

    def link(found: re.Match) -> str:
        place = outside(page, found[2])
        return found[0] if place is None else f"{found[1]}{repository}/{place}{found[3]}"

    return LINK.sub(link, text)


def visit(items: list, repository: str) -> None:
    """Rewrites every chapter below these items."""
    for item in items:
        chapter = item.get("Chapter") if isinstance(item, dict) else None
        if chapter and chapter.get("path"):
            # README.md of a folder is index.md by now; its own name does not matter for links.
            chapter["content"] = rewritten(chapter["path"], chapter["content"], repository)
            visit(chapter["sub_items"], repository)


def main() -> None:
    if sys.argv[1:2] == ["supports"]:
        return
    context, book = json.load(sys.stdin)
    repository = context["config"]["preprocessor"]["forge-links"]["repository"]
    visit(book.get("items") or book["sections"], repository)
    json.dump(book, sys.stdout)


if __name__ == "__main__":
    main()
