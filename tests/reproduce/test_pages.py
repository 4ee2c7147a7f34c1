"""The pages of the thesis: an index of all verdicts that leads to every item, a page a chapter, and one page of all."""

import re
from html.parser import HTMLParser
from pathlib import Path

import pytest

from train.reproduce.catalogue import FUTURE_WORK, STUDIES, THESIS, THESIS_STUDIES
from train.reproduce.judging.second import Second
from train.reproduce.judging.verdicts import Judgement, Verdict
from train.reproduce.overview import why
from train.reproduce.report import documentation, html_page, markdown_page
from train.reproduce.runner import Record
from train.shared.markdown import escaped

ROOT = Path(__file__).parents[2]
MANY = (("1", "2"),) * 40


def record(study, first=Verdict.REPRODUCED, second=Verdict.NOT_REPRODUCED):
    judgements = {each.key: Judgement(first, "rise", "3 of 3 steps rise", "+1 %") for each in study.statements}
    seconds = {each.key: Second(second, "2 of 3 steps rise", "-1 %") for each in study.statements}
    return Record(study.name, 0.0, judgements, seconds, header=("x", "y"), rows=MANY if study.tabulated else ())


@pytest.fixture(scope="module")
def pages():
    return documentation([record(study) for study in STUDIES], "figures")


def links(text):
    return re.findall(r"\]\(([^)\s]+)\)", text)


def anchors(text):
    return set(re.findall(r'<a id="([^"]+)">', text))


def test_there_is_an_index_and_a_page_for_each_chapter(pages):
    chapters = [f"thesis-chapter-{number}.md" for number in (2, 3, 5, 6)]
    assert list(pages) == ["thesis.md", *chapters, "thesis-future-work.md"]
    assert all(page.startswith("# ") for page in pages.values())


def test_every_link_between_the_pages_leads_to_a_place_that_is_there(pages):
    found = [target for page in pages.values() for target in links(page) if not target.startswith("figures/")]
    assert len(found) > 2 * len(STUDIES)
    for target in found:
        page, _, place = target.partition("#")
        if page not in pages:
            assert page in ("beyond-the-thesis.md", "physics.md", "thesis-errata.md", "validation.md")
            headings = re.findall(r"^#+ (.+)$", (ROOT / "docs" / page).read_text(encoding="utf-8"), re.MULTILINE)
            assert not place or place in [heading.lower().replace(" ", "-") for heading in headings], target
        else:
            assert not place or place in anchors(pages[page]), target


def test_every_item_and_every_statement_is_in_the_index_with_both_verdicts(pages):
    listed = pages["thesis.md"].partition("## All tables, figures and statements")[2]
    rows = [line for line in listed.splitlines() if line.startswith("| [")]
    for study in THESIS_STUDIES:
        own = [row for row in rows if f"#{study.name})" in row.split(" | ")[0]]
        assert len(own) == 1 + len(study.own_statements)
        assert all("| ● reproduced | ○ not reproduced |" in row for row in own)
    assert sum(f"#{study.name})" in row for row in rows for study in FUTURE_WORK[1]) == len(FUTURE_WORK[1])


def test_a_chapter_shows_its_own_items_and_no_others(pages):
    for title, studies in THESIS:
        page = pages[f"thesis-chapter-{title[8]}.md"]
        assert re.findall(r"!\[.*\]\(figures/(.*)\.png\)", page) == [study.name for study in studies]


def test_long_tables_of_numbers_are_folded_and_short_ones_are_not(pages):
    assert "<summary>The numbers, 40 rows</summary>" in pages["thesis-chapter-3.md"]
    (table,) = [study for study in THESIS_STUDIES if study.name == "table-3.4"]
    short = record(table)
    page = documentation([Record(**{**{name: getattr(short, name) for name in Record.__slots__}, "rows": MANY[:5]})], "figures")
    assert "The numbers" not in page["thesis-chapter-3.md"] and "| 1 | 2 |" in page["thesis-chapter-3.md"]


def test_what_is_folded_is_closed_again(pages):
    for page in pages.values():
        assert page.count("<details markdown>\n<summary>") == page.count("</details>")


def test_links_of_the_one_page_stay_on_it():
    page = markdown_page([record(study) for study in STUDIES])
    targets = [target for target in links(page) if not target.endswith(".png")]
    assert "in words: Beyond the thesis." in page and ".md" not in page
    assert targets and all(target.startswith("#") and target[1:] in anchors(page) for target in targets)


class Balance(HTMLParser):
    """Tags that are open, and what links lead to."""

    def __init__(self):
        super().__init__()
        self.open, self.targets, self.places = [], set(), set()

    def handle_starttag(self, tag, attrs):
        if tag not in ("meta", "img"):
            self.open.append(tag)
        self.places |= {value for name, value in attrs if name == "id"}
        self.targets |= {value for name, value in attrs if name == "href"}

    def handle_endtag(self, tag):
        assert self.open.pop() == tag


def test_the_html_page_is_well_formed_and_its_links_lead_somewhere(tmp_path):
    for study in STUDIES:
        (tmp_path / f"{study.name}.png").write_bytes(b"picture")
    found = Balance()
    found.feed(html_page([record(study) for study in STUDIES], tmp_path))
    assert found.open in ([], ["html"])
    assert len(found.targets) >= len(STUDIES) and {target[1:] for target in found.targets} <= found.places


def test_the_paragraph_of_reasons_counts_what_the_table_counts():
    half = len(THESIS_STUDIES) // 2
    records = [record(study, Verdict.NOT_REPRODUCED, Verdict.TREND) for study in THESIS_STUDIES[:half]]
    records += [record(study, Verdict.TREND, Verdict.REPRODUCED) for study in THESIS_STUDIES[half:]]
    wrong, rest = (sum(len(study.own_statements) for study in part) for part in (THESIS_STUDIES[:half], THESIS_STUDIES[half:]))
    told = why(records)
    assert told.startswith(f"Of {wrong + rest} statements 0 hold in nature, {rest} hold in trend, {wrong} do not hold and 0 cannot")
    assert f"Of the {half} that fail in nature, 0 have other statements that hold." in told
    assert f"its equations explain {rest}, and {wrong} in trend" in told
    assert "Its comparisons with" not in told
    assert "Its comparisons with an experiment" in why([record(study) for study in THESIS_STUDIES])


def test_a_remark_names_the_statements_that_it_is_of(pages):
    for title, studies in THESIS:
        page = pages[f"thesis-chapter-{title[8]}.md"]
        for study in studies:
            for statement in study.statements:
                if statement.remark:
                    lines = [line for line in page.splitlines() if line.endswith(escaped(statement.remark))]
                    assert any(f"“{escaped(statement.text)}”" in line for line in lines)
