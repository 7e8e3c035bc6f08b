#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""capture.py live URL LIGHT DARK
   capture.py report FILE OUT START END WIDTH

Takes pictures with headless Chromium, as WebP.
`live` waits until the live page at URL names an element that lost stiffness, then takes the page in both color schemes.
It hides damping, modes and the list of drifts, so that verdict, building and element fit one picture.
`report` lays FILE out WIDTH pixels wide and takes it from the top of the element START to the bottom of the element END
(both JavaScript)."""
import base64
import os
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tests/browser"))
import chromium

LIMIT_BYTES = 150_000
LIVE_WIDTH = 1200  # CSS pixels
HIDDEN = """#answers li ul, #building-card h2:nth-of-type(2), #modes, #boxes-card h2:nth-of-type(2), #boxes-card .across:nth-of-type(n+3) { display: none }
            #building { flex-basis: 310px !important } ::-webkit-scrollbar { display: none }"""
NAMED = "document.getElementById('findings').textContent.includes('of its stiffness')"
SETTLE_S = 6  # after the change is named: until a window holds only samples after it


def emulate(browser, tab, width, scheme):
    browser.ask("Emulation.setEmulatedMedia", tab.session, features=[{"name": "prefers-color-scheme", "value": scheme}])
    browser.ask("Emulation.setDeviceMetricsOverride", tab.session, width=width, height=1400, deviceScaleFactor=1,
                mobile=False)


def take(browser, tab, width, bottom, out, top=0):
    """Writes the page from `top` to `bottom` (CSS pixels), at the best quality that keeps the limit."""
    for quality in (95, 90, 85, 80, 70, 60):
        data = browser.ask("Page.captureScreenshot", tab.session, format="webp", quality=quality,
                           captureBeyondViewport=True,
                           clip={"x": 0, "y": top, "width": width, "height": bottom - top, "scale": 1})["data"]
        picture = base64.b64decode(data)
        if len(picture) <= LIMIT_BYTES:
            break
    with open(out, "wb") as file:
        file.write(picture)
    print(f"{out}: {len(picture)} bytes, {width} x {round(bottom - top)}, quality {quality}")


def take_live(browser, url, light, dark):
    tab = browser.open(url)
    emulate(browser, tab, LIVE_WIDTH, "light")
    if not tab.until(NAMED, 60):
        sys.exit("the page names no change")
    # The page's content security policy forbids <style> elements.
    tab.value(f"const hide = new CSSStyleSheet(); hide.replaceSync(`{HIDDEN}`); document.adoptedStyleSheets = [hide]")
    time.sleep(SETTLE_S)
    for out in (light, dark):
        bottom = tab.value("document.getElementById('building-card').getBoundingClientRect().bottom + scrollY + 6")
        take(browser, tab, LIVE_WIDTH, bottom, out)
        tab.value("document.getElementById('theme').click()")
        time.sleep(1)


def take_report(browser, file, out, start, end, width):
    tab = browser.open("file://" + os.path.abspath(file))
    emulate(browser, tab, int(width), "light")
    if not tab.until("document.readyState === 'complete'"):
        sys.exit(f"{file} does not load")
    bottom = tab.value(f"({end}).getBoundingClientRect().bottom + scrollY + 24")
    top = tab.value(f"({start}).getBoundingClientRect().top + scrollY")
    take(browser, tab, int(width), bottom, out, top)


def main():
    takes = {"live": (take_live, 5), "report": (take_report, 7)}
    action, count = takes.get(sys.argv[1] if len(sys.argv) > 1 else "", (None, 0))
    if len(sys.argv) != count:
        sys.exit(__doc__)
    browser = chromium.Chromium()
    try:
        action(browser, *sys.argv[2:])
    finally:
        browser.end()


main()
