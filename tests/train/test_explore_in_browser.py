"""The explorer in a real browser: sliders redraw it without an error, and it can be read in both themes and on a telephone."""

import threading

import pytest

pytest.importorskip("dash", reason="dash is not installed")
webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
support = pytest.importorskip("selenium.webdriver.support.ui")

pytestmark = pytest.mark.slow

MARKED_SPEED = "return document.querySelector('#campbell .js-plotly-plot').layout.shapes.at(-1).x0"
IDLE = "document.documentElement.dataset.busy === 'false' && document.querySelectorAll('#damping tr').length === 11"


@pytest.fixture(scope="module")
def address():
    from train.explore import serve

    server = serve(0)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.port}/"
    server.shutdown()
    server.server_close()


@pytest.fixture
def show(browser, address):
    """Load the page on a screen of this width under the system's colour scheme, and wait until all is drawn."""

    def load(width=1200, scheme="light"):
        screen = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": False}
        browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
        browser.get(address)
        wait(browser, "return " + IDLE)
        return browser

    return load


def wait(browser, condition, seconds=90.0):
    support.WebDriverWait(browser, seconds, 0.05).until(lambda _: browser.execute_script(condition), condition)


def press(browser, slider, key, handle=0, times=1):
    for _ in range(times):
        browser.find_elements("css selector", f"#{slider} [role=slider]")[handle].send_keys(key)


def test_a_slider_redraws_every_figure_without_an_error(show, address):
    browser = show()
    names = ("campbell", "response", "shape-0", "damping")
    before = {name: browser.find_element("id", name).get_attribute("innerHTML") for name in names}
    assert browser.execute_script(MARKED_SPEED) == 200
    press(browser, "speed", webdriver.Keys.ARROW_RIGHT, times=6)
    wait(browser, f"{MARKED_SPEED} === 230 && {IDLE}")
    for name in names:
        assert browser.find_element("id", name).get_attribute("innerHTML") != before[name], name
    assert [entry for entry in browser.get_log("browser") if entry["level"] == "SEVERE"] == []
    loaded = browser.execute_script("return performance.getEntriesByType('resource').map((entry) => entry.name)")
    assert [name for name in loaded if not name.startswith((address, "data:"))] == []


def test_moves_that_follow_each_other_quickly_end_at_the_last(show):
    browser = show()
    press(browser, "speed", webdriver.Keys.ARROW_RIGHT, times=20)
    wait(browser, f"{MARKED_SPEED} === 300 && {IDLE}")
    press(browser, "speed", webdriver.Keys.ARROW_LEFT, times=20)
    wait(browser, f"{MARKED_SPEED} === 200 && {IDLE}")


def test_patches_stop_where_they_would_overlap(show):
    browser = show()
    press(browser, "actuators", webdriver.Keys.PAGE_DOWN, handle=1, times=8)
    wait(browser, f"return document.getElementById('actuators-value').textContent !== '0.0, 443.7, 887.4, 1331.1 mm' && {IDLE}")
    first, second, *others = (float(edge) for edge in browser.find_element("id", "actuators-value").text.rstrip(" m").split(", "))
    assert (first, others) == (0.0, [887.4, 1331.1])
    assert 85.0 <= second < 443.7
    assert browser.find_element("id", "message").text == ""


def test_what_makes_no_blade_is_told_and_leaves_the_sliders_usable(show):
    browser = show()
    browser.execute_script("dash_clientside.set_props('sensors', {value: [0, 20, 500, 900]})")  # the slider keeps them apart
    wait(browser, "return document.getElementById('results').hidden")
    assert "overlap" in browser.find_element("id", "message").text
    browser.execute_script("dash_clientside.set_props('sensors', {value: [0, 300, 500, 900]})")
    wait(browser, f"return !document.getElementById('results').hidden && {IDLE}")
    assert browser.find_element("id", "message").text == ""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_text_has_the_theme_s_ink(show, scheme):
    from train.figures.themes import THEMES

    browser = show(scheme=scheme)
    expected = "rgb({}, {}, {})".format(*bytes.fromhex(THEMES[scheme].ink[1:]))
    texts = "#results .cartesianlayer text, #results .infolayer text"
    colours = f"return [...document.querySelectorAll('{texts}')].map((text) => getComputedStyle(text).fill)"
    assert set(browser.execute_script(colours)) == {expected}
    values = (
        "return [...document.querySelectorAll('#controls output, #controls label')].map((text) => getComputedStyle(text).color)"
    )
    assert set(browser.execute_script(values)) == {expected}


@pytest.mark.parametrize("width", [400, 1200])
def test_nothing_is_wider_than_the_screen(show, width):
    browser = show(width)
    assert browser.execute_script("return document.documentElement.scrollWidth") <= width
