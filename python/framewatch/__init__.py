# SPDX-License-Identifier: MIT
"""Stiffness and damping of a building from its accelerometers, with an error on each number.

The functions do what the program framewatch does, with the same results to the bit. They release
the GIL while they compute. Ctrl-C ends them with KeyboardInterrupt. Bad input is an Error, a
ValueError whose text has one line per problem, as the program prints them.

A process can use the module in one interpreter only. After os.fork() the child can use it, but not
an Estimator that another thread was using during the fork. See docs/python.md.
"""
from __future__ import annotations

import math
import os
from typing import Any, Callable, Iterable, Optional, Sequence, Union

from . import _core

_core.claim_interpreter()  # before numpy, which a second interpreter should not import either

# pylint: disable=wrong-import-position
import numpy as np
import numpy.typing as npt

from ._arrays import REASON, STATUS, Estimates, Parameter, Record
from ._core import Error
from ._diagnosis import Diagnosis, Effect, Gap, Place, Value

Error.__module__ = "framewatch"
__version__: str = _core.version
__all__ = [
    "Building", "Diagnosis", "Effect", "Error", "Estimates", "Estimator", "Gap", "Parameter",
    "Place", "REASON", "Record", "STATUS", "Value", "diagnose", "read_record", "replay", "simulate",
]

Path = Union[str, "os.PathLike[str]"]
Progress = Callable[[str, float], object]
"""Gets the current work and the share that is done, 0 to 1, at most 20 times a second. An exception
that it raises ends the work and reaches the caller."""


class Building(_core.Building):
    """A building as a configuration file describes it: structure, channels, options.

    name, path, sha256; stories; channels: their names, the columns of accelerations; parameters,
    units: of the estimates; design: float64, shape (parameters,), SI, or None; rate_hz, window_s;
    doubts: values that are allowed but implausible, a line each.
    """

    @classmethod
    def from_toml(cls, path_or_text: Path) -> Building:
        """Reads a configuration file, or TOML in a string, which contains "=" or a line end.

        Paths in a text are relative to the working directory. Raises Error with every problem.
        """
        return cls(*_text_of(path_or_text))

    def __repr__(self) -> str:
        return f"<framewatch.Building {self.name!r}: {self.stories} stories, channels {self.channels}>"


class Estimator:
    """Estimates while samples come in, as the program does live (`replay --one-pass`)."""

    def __init__(self, building: Union[Building, Path]) -> None:
        """building: a Building, or what Building.from_toml() takes."""
        self.building = _building(building)
        self._estimator = _core.Estimator(self.building)

    def push(self, time: npt.ArrayLike, accel: npt.ArrayLike) -> Estimates:
        """Takes instants and returns the estimates of the windows that ended.

        time: shape (n,), increasing: float64 in s, or int64 in us.
        accel: shape (n, channels), float64 or float32, m/s^2 before calibration, columns as
            building.channels. NaN is a lost sample. No strides are copied.

        Raises Error if shape, type or order is wrong; then no instant of the call was taken. After
        Ctrl-C, newest_us tells the last one that was taken.
        """
        arrays = self._estimator.push(np.asarray(time), np.asarray(accel))
        return Estimates._of(self.building.parameters, self.building.units, arrays)

    def finish(self) -> Estimates:
        """Ends the input and returns the last estimates."""
        arrays = self._estimator.finish()
        return Estimates._of(self.building.parameters, self.building.units, arrays)

    @property
    def newest_us(self) -> Optional[int]:
        """Time of the newest instant that was taken, us; None before the first."""
        return self._estimator.newest_us


def read_record(
    path: Union[Path, Sequence[Path]], *, channel: str = "", unit: str = "", step_s: float = 0,
    format: str = "detect", time: str = "", time_unit: str = "", zone: str = "", decimal: str = "",
    columns: Sequence[str] = (), names: Sequence[str] = (), station_xml: Path = "",
) -> Record:
    """Reads a record in any format of `framewatch convert`, or an LCM event log.

    path: a file, or the files of one motion, such as one per station channel.
    channel: LCM channel of an event log with several.
    The others say what a file does not say itself, as the options of `framewatch convert` do: unit
    (g, mg, gal, mps2 or a number of m/s^2), step_s, format, time (title of its column), time_unit,
    zone, decimal, columns, names, station_xml.

    Raises Error with every problem as file:line.
    """
    options = _options(
        unit, step_s, format, time, time_unit, zone, decimal, columns, names, station_xml
    )
    return Record(**_core.read_record(_paths(path), channel, options))


def simulate(
    scenario: Path, *, building: Optional[Building] = None, duration_s: float = 0,
    progress: Optional[Progress] = None,
) -> Record:
    """Shakes a virtual building and returns what its sensors measure.

    scenario: a scenario file, or TOML in a string.
    building: replaces the file of the scenario's key config.
    duration_s: replaces the scenario's, s; 0: keeps it.
    """
    path, text = _text_of(scenario)
    return Record(**_core.simulate(path, text, building, duration_s, _callable(progress)))


def replay(
    config: Union[Building, Path], record: Union[Path, Record, Sequence[Union[Path, Record]]], *,
    one_pass: bool = False, salvage: bool = False, from_s: float = 0, to_s: float = math.inf,
    unit: str = "", step_s: float = 0, format: str = "detect", time: str = "", time_unit: str = "",
    zone: str = "", decimal: str = "", columns: Sequence[str] = (), names: Sequence[str] = (),
    station_xml: Path = "", progress: Optional[Progress] = None,
) -> Estimates:
    """Estimates a whole record, as `framewatch replay` does, with the same numbers.

    config: a Building, or what Building.from_toml() takes.
    record: a record file, LCM event log, candump log or Record, or several in order of time, files
        before Records.
    one_pass: does not tune on the record first. salvage: skips damaged input.
    from_s, to_s: part of the input, s after its first sample.
    The options from unit to station_xml: see read_record().

    Raises Error with every problem.
    """
    building = _building(config)
    if not to_s > from_s:
        raise Error("to_s: must be later than from_s")
    many = [record] if isinstance(record, (str, os.PathLike, Record)) else list(record)
    paths = [os.fspath(r) for r in many if not isinstance(r, Record)]
    records = [
        (f"record {i}", r.names, r.units, r.time_s, r.accel, r.rate_hz)
        for i, r in enumerate(many) if isinstance(r, Record)
    ]
    if not many:
        raise Error("record: needs one or more")
    options = _options(
        unit, step_s, format, time, time_unit, zone, decimal, columns, names, station_xml
    )
    arrays, notes = _core.replay(
        building, paths, records, one_pass, salvage, from_s, to_s, options, _callable(progress)
    )
    return Estimates._of(building.parameters, building.units, arrays, notes)


def diagnose(
    config: Union[Building, Path], *, train: Union[Path, Sequence[Path]],
    held_out: Union[Path, Sequence[Path]], without: Iterable[str] = (), threads: int = 0,
    force: str = "", displacement: bool = False, prescribed: bool = False,
    limit_s: float = 0, progress: Optional[Progress] = None,
) -> Diagnosis:
    """Finds why a linear model does not repeat a building's records, as `framewatch diagnose` does.

    config: a Building, or what Building.from_toml() takes.
    train, held_out: record files or LCM event logs. The model is fitted to the first and judged by
        the second.
    without: names of effects to exclude. threads: 0 means as many as the machine has. The result
        does not depend on it.
    force, displacement, prescribed: of a component test (docs/force.md): the column of the force,
        whether floor 1 measures displacement, whether the motion is prescribed.
    limit_s: longest time of the search, s; it then ends with what it has found, and not_done says
        what it did not do. 0: no limit, so that the result does not depend on the machine.

    Takes minutes. Ctrl-C or an exception of `progress` ends it within seconds.
    """
    building = _building(config)
    return Diagnosis._of(
        _core.diagnose(
            building, _paths(train), _paths(held_out), list(without), threads,
            force, displacement, prescribed, limit_s, _callable(progress),
        )
    )


def _text_of(path_or_text: Path) -> tuple[str, str]:
    """Returns the path of a TOML text for messages, and the text."""
    if isinstance(path_or_text, str) and ("\n" in path_or_text or "=" in path_or_text):
        return "<text>", path_or_text
    path = os.fspath(path_or_text)
    return path, _core.read_text(path)


def _building(config: Union[Building, Path]) -> Building:
    return config if isinstance(config, Building) else Building.from_toml(config)


def _paths(paths: Union[Path, Sequence[Path]]) -> list[str]:
    many = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    if not many:
        raise Error("records: needs one or more files")
    return [os.fspath(path) for path in many]


def _options(*values: Any) -> dict[str, Any]:
    keys = ("unit", "step_s", "format", "time", "time_unit", "zone", "decimal", "columns", "names")
    options = dict(zip(keys, values))
    options["columns"], options["names"] = list(options["columns"]), list(options["names"])
    options["station_xml"] = os.fspath(values[-1])
    return options


def _callable(progress: Optional[Progress]) -> Optional[Progress]:
    if progress is not None and not callable(progress):
        raise TypeError("progress: is not callable")
    return progress
