"""Pages in a real browser, narrow and wide, light and dark.

Nothing sticks out, all can be read, nothing complains: it looks at the layout, not at pixels.
"""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path
from typing import Any

import pytest

from narrows.papers.session import Plan, carry_out
from narrows.report import report_run
from tests.narrows.papers.tiny import paper

BROWSERS = ("chromium", "chromium-browser", "google-chrome", "chrome")
BROWSER = next(filter(None, map(shutil.which, BROWSERS)), None)
NARROW, WIDE = 390, 1280  # pixels: a telephone, a screen
CONTRAST = 4.5  # least ratio of luminances of small text, WCAG 2.1, 1.4.3
SCHEMES = {"dark": 0, "light": 1}  # as Blink numbers them

pytestmark = pytest.mark.skipif(
    BROWSER is None, reason=f"no browser on the path: {', '.join(BROWSERS)}"
)

LOOK = """<!DOCTYPE html><html><body style="margin:0">
<iframe id="frame" style="border:0;width:WIDTHpx;height:900px" src="NAME"></iframe>
<pre id="told"></pre>
<script>
const luminance = (r, g, b) => [r, g, b].map(c => c / 255).map(
  c => c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4
).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
const parts = colour => colour.match(/[\\d.]+/g).map(Number);
const ground = (view, node) => {
  for (let at = node; at; at = at.parentElement) {
    const [r, g, b, a = 1] = parts(view.getComputedStyle(at).backgroundColor);
    if (a === 1) return [r, g, b];
  }
  return [255, 255, 255];
};
frame.onload = () => {
  const page = frame.contentDocument, view = frame.contentWindow, root = page.documentElement;
  const name = node => `${node.tagName} ${node.className} ${node.textContent.trim().slice(0, 40)}`;
  const all = [...page.body.querySelectorAll('*')];
  const outside = all.filter(node => !node.closest('.scroll > *')
    && node.getBoundingClientRect().right > root.clientWidth + 1).map(name);
  const pale = all.filter(node => [...node.childNodes].some(
    child => child.nodeType === 3 && child.textContent.trim())).map(node => {
      const a = luminance(...parts(view.getComputedStyle(node).color));
      const b = luminance(...ground(view, node));
      return [name(node), (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05)];
    }).filter(([_, ratio]) => ratio < LEAST);
  const images = [...page.images];
  told.textContent = JSON.stringify({
    width: view.innerWidth, scrolled: root.scrollWidth, outside, pale,
    pictures: images.length,
    broken: images.filter(image => !image.naturalWidth).map(image => image.alt),
    silent: images.filter(image => image.alt.length < 20).length,
    columns: [...page.querySelectorAll('.pair')].map(
      pair => view.getComputedStyle(pair).gridTemplateColumns.split(' ').length),
    dark: view.matchMedia('(prefers-color-scheme: dark)').matches,
    links: [...page.querySelectorAll('a[href^="#"]')].filter(
      link => !page.getElementById(link.getAttribute('href').slice(1))).length,
  });
};
</script></body></html>
"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The page of a paper, and that of one of its runs."""
    out = tmp_path_factory.mktemp("paper")
    whole = paper()
    plan = Plan(whole, whole.figures, "quick", out)
    carry_out(plan, jobs=1)
    return {"paper": out / "index.html", "run": report_run(plan.runs[0].folder)}


def look(page: Path, width: int, scheme: str, profile: Path) -> tuple[dict[str, Any], list[str]]:
    """What the browser found, and what its console said."""
    text = LOOK.replace("NAME", page.name).replace("WIDTH", str(width))
    host = page.with_name("look.html")
    host.write_text(text.replace("LEAST", str(CONTRAST)), encoding="utf-8")
    assert BROWSER
    options = [
        *("--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files"),
        *("--enable-logging=stderr", "--virtual-time-budget=20000", f"--user-data-dir={profile}"),
        *(f"--blink-settings=preferredColorScheme={SCHEMES[scheme]}", "--window-size=1400,1000"),
    ]
    done = subprocess.run(
        [BROWSER, *options, "--dump-dom", host.as_uri()],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    (told,) = re.findall(r'<pre id="told">(.*?)</pre>', done.stdout, re.DOTALL)
    console = [line for line in done.stderr.splitlines() if ":CONSOLE" in line]
    return json.loads(unescape(told)), console


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("width", [NARROW, WIDE])
@pytest.mark.parametrize("name", ["paper", "run"])
def test_the_layout_of_a_page(
    name: str, width: int, scheme: str, pages: dict[str, Path], tmp_path: Path
) -> None:
    found, console = look(pages[name], width, scheme, tmp_path)
    assert console == []
    assert found["width"] == width
    assert found["scrolled"] <= width
    assert found["outside"] == []
    assert found["pale"] == []
    assert found["dark"] == (scheme == "dark")
    assert found["pictures"] >= 2
    assert found["broken"] == []
    assert found["silent"] == 0
    assert found["links"] == 0
    assert found["columns"]
    if width == NARROW:
        assert set(found["columns"]) == {1}


@pytest.mark.parametrize(
    ("spoil", "where"),
    [
        (("<main>", '<main><p style="width: 700px">wide</p>'), "outside"),
        (("<main>", '<main><p style="color: #ccc">pale</p>'), "pale"),
        (('<img alt="', '<img src="none.png" alt="'), "broken"),
    ],
    ids=["wide", "pale", "broken"],
)
def test_the_look_sees_what_is_wrong(
    spoil: tuple[str, str], where: str, pages: dict[str, Path], tmp_path: Path
) -> None:
    page = tmp_path / "spoiled.html"
    page.write_text(pages["paper"].read_text(encoding="utf-8").replace(*spoil), encoding="utf-8")
    found, _ = look(page, NARROW, "light", tmp_path / "profile")
    assert found[where]
