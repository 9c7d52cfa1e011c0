# SPDX-License-Identifier: Apache-2.0
# Is FILE a page as report.html has to be? Prints what is wrong, a line each.
#     page.py FILE FIGURES PICTURES      (PICTURES 0: any number)
import re
import sys
import xml.parsers.expat
from html.parser import HTMLParser

wrong = []


class Page(HTMLParser):
    void = {"meta", "img", "br", "wbr", "link", "hr", "input"}

    def __init__(self):
        super().__init__(convert_charrefs=True)
        self.ids, self.wanted, self.open, self.count, self.level, self.words = [], [], [], {}, 0, {}

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.count[tag] = self.count.get(tag, 0) + 1
        if tag not in self.void:
            self.open.append(tag)
        if "id" in given:
            self.ids.append(given["id"])
        self.wanted += (given.get("aria-labelledby", "") + " " + given.get("aria-describedby", "")).split()
        for name, value in attributes:
            if name.startswith("on"):
                wrong.append(f"<{tag}> has {name}")
            if name in ("src", "href", "data", "action", "srcset", "poster") and not (value or "").startswith("data:image/png;base64,"):
                wrong.append(f"<{tag}> {name}='{(value or '')[:60]}'")
        if tag == "html" and given.get("lang") != "en":
            wrong.append("no language")
        if tag == "img" and not given.get("alt", "").strip():
            wrong.append("<img> without a text alternative")
        if tag == "th" and given.get("scope") not in ("col", "row"):
            wrong.append("<th> without scope")
        if tag == "svg" and given.get("aria-hidden") != "true" and (given.get("role") != "img" or "aria-labelledby" not in given):
            wrong.append("<svg> without role or name")
        if re.fullmatch("h[1-6]", tag):
            if int(tag[1]) > self.level + 1:
                wrong.append(f"<{tag}> behind <h{self.level}>")
            self.level = int(tag[1])
        if tag in ("script", "iframe", "object", "embed", "link", "base", "form"):
            wrong.append(f"<{tag}>")

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.void:
            self.open.pop()

    def handle_endtag(self, tag):
        if not self.open or self.open.pop() != tag:
            wrong.append(f"</{tag}> closes something else")

    def handle_data(self, data):
        for tag in self.open[-1:]:
            self.words[tag] = self.words.get(tag, 0) + len(data.strip())


name, figures, pictures = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
text = open(name, "rb").read()
try:
    xml.parsers.expat.ParserCreate().Parse(text, True)
except xml.parsers.expat.ExpatError as error:
    wrong.append(f"not well-formed: {error}")
page = Page()
page.feed(text.decode())
page.close()
if page.open:
    wrong.append(f"left open: {page.open}")
if len(set(page.ids)) != len(page.ids):
    wrong.append("an id stands twice")
wrong += [f"nothing has the id {wanted}" for wanted in page.wanted if wanted not in page.ids]
if page.count.get("h1") != 1 or page.count.get("main") != 1 or not page.words.get("title"):
    wrong.append("not one <h1>, <main> and <title>")
if page.count.get("figure", 0) != figures or (pictures and page.count.get("img", 0) != pictures):
    wrong.append(f"{page.count.get('figure', 0)} figures and {page.count.get('img', 0)} pictures instead of {figures} and {pictures}")
if page.count.get("figcaption", 0) != figures:
    wrong.append("a figure without a caption")
if not page.words.get("desc"):
    wrong.append("plots without a text alternative")
if re.search(rb"https?:|url\(|@import", text):
    wrong.append("an address of elsewhere")
print("\n".join(wrong), end="")
