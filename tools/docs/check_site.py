#!/usr/bin/env python3
"""Checks that every link, anchor and picture of the built site exists: check_site.py FOLDER. Links
to other sites are not followed."""
import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):

    def __init__(self, path):
        super().__init__()
        self.ids, self.links = set(), []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name == "id" or (name == "name" and tag == "a"):
                self.ids.add(value)
            elif name in ("href", "src") and value and tag != "link":
                self.links.append(value)


def wrong_links(folder):
    pages = {path.resolve(): Page(path) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent /
                      urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if not target.exists():
                yield f"{path.relative_to(folder)}: no {link}"
            elif parts.fragment and target in pages and urllib.parse.unquote(
                    parts.fragment) not in pages[target].ids:
                yield f"{path.relative_to(folder)}: no such place: {link}"
    if len(pages) < 30:
        yield f"only {len(pages)} pages"


def main(folder):
    wrong = list(wrong_links(pathlib.Path(folder).resolve()))
    print(*wrong, f"{len(wrong)} links lead nowhere", sep="\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
