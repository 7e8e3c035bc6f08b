# SPDX-License-Identifier: MIT
"""expressions.py PROMETHEUS BOARD: queries a Prometheus for every expression of the board and of its
loaded rules. Exits with 1 if one is not valid PromQL, if one has no series while a building shakes, or if a wrong alert
fires."""
import json
import re
import sys
import time
import urllib.error
import urllib.parse
import urllib.request

LONGEST_S = 90  # until everything has been seen
# Expressions that need a working CAN bus.
WITHOUT_CAN = {"framewatch_can_load_ratio"}
# Expressions that need a hub of many buildings (./test --fleet).
OF_A_HUB = "framewatch_uplink_"
# Alerts for the two buildings of tests/metrics/run: the second one has no sensors.
EXPECTED_ALERTS = {"FramewatchCanBus", "FramewatchStiffnessChange", "FramewatchGap"}


def series(prometheus, expression):
    """Returns the number of series; None if it is not valid PromQL."""
    query = urllib.parse.urlencode({"query": expression})
    try:
        with urllib.request.urlopen(f"{prometheus}/api/v1/query?{query}") as answer:
            return len(json.load(answer)["data"]["result"])
    except urllib.error.HTTPError as error:
        print(json.load(error)["error"])
        return None


def board_expressions(path):
    with open(path) as file:
        board = json.load(file)
    for panel in board["panels"]:
        for target in panel.get("targets", []):
            yield panel["title"], target["expr"].replace("$__rate_interval", "30s").replace(
                "$instance", ".*"
            )


def rules(prometheus):
    with urllib.request.urlopen(f"{prometheus}/api/v1/rules") as answer:
        for group in json.load(answer)["data"]["groups"]:
            for rule in group["rules"]:
                yield rule["name"], rule["query"]


def missing(prometheus, board):
    out = []
    for title, expression in board_expressions(board):
        count = series(prometheus, expression)
        if count is None:
            sys.exit(f"the board's '{title}' is no PromQL: {expression}")
        if count == 0 and not any(name in expression for name in WITHOUT_CAN):
            out.append(f"'{title}': {expression}")
    for name, expression in rules(prometheus):
        for metric in set(re.findall(r"framewatch_\w+", expression)):
            if not metric.startswith(OF_A_HUB) and series(prometheus, metric) == 0:
                out.append(f"rule {name}: {metric}")
    return out


def main(prometheus, board):
    end = time.monotonic() + LONGEST_S
    lacking = ["Prometheus does not answer"]
    while lacking and time.monotonic() < end:
        time.sleep(1)
        try:
            lacking = missing(prometheus, board)
        except urllib.error.URLError:
            continue
    if lacking:
        sys.exit("no series after %d s:\n  %s" % (LONGEST_S, "\n  ".join(lacking)))
    if series(prometheus, "no_such_metric") != 0 or series(prometheus, "sum(") is not None:
        sys.exit("a missing metric and a broken expression look like good ones")
    with urllib.request.urlopen(f"{prometheus}/api/v1/alerts") as answer:
        firing = {
            alert["labels"]["alertname"]
            for alert in json.load(answer)["data"]["alerts"]
            if alert["state"] == "firing"
        }
    if firing - EXPECTED_ALERTS:
        sys.exit(f"alerts that nothing is the reason of: {sorted(firing - EXPECTED_ALERTS)}")
    boards = sum(1 for _ in board_expressions(board))
    alerts = sum(1 for _ in rules(prometheus))
    print(f"{boards} expressions of the board and {alerts} rules: all have series")


main(*sys.argv[1:])
