# SPDX-License-Identifier: MIT
"""Records and estimates as numpy arrays."""
from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Optional

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import pandas

STATUS = ("warming_up", "valid", "nothing_identifiable")
"""Words for Estimates.status, by number."""
REASON = ("observable", "warming_up", "quiet", "floor_too_stiff", "symmetric_plan", "channel_lost")
"""Words for Estimates.reason, by number: why a parameter has no value in a window."""


@dataclass(eq=False)
class Record:
    """Motion of a building over some time: every channel at every instant.

    Make one from arrays, or by read_record() and simulate().

    names: one per channel.
    time_s: float64, shape (n,), s, increasing. Since 1970 UTC if the file states its time.
    accel: float64, shape (n, channels), m/s^2 (N for a force); NaN where a sample is missing.
    units: one per channel, "m/s^2" or "N". Empty: all m/s^2.
    rate_hz: sampling rate, Hz. 0: from the median step.
    notes: what the reader assumed or left out, for a person.
    """

    names: list[str]
    time_s: npt.NDArray[np.float64]
    accel: npt.NDArray[np.float64]
    units: list[str] = field(default_factory=list)
    rate_hz: float = 0.0
    notes: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.names = list(self.names)
        self.units = list(self.units) or ["m/s^2"] * len(self.names)
        self.time_s = np.asarray(self.time_s)
        self.accel = np.asarray(self.accel)

    @property
    def start_s(self) -> float:
        """Time of the first instant, s."""
        return float(self.time_s[0])

    def __getitem__(self, name: str) -> npt.NDArray[np.float64]:
        """Returns the values of a channel, shape (n,), without a copy."""
        if name not in self.names:
            raise KeyError(name)
        return self.accel[:, self.names.index(name)]

    def __len__(self) -> int:
        return len(self.time_s)

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a DataFrame with time_s as its index and a column per channel. Needs pandas."""
        import pandas

        return pandas.DataFrame(
            self.accel, index=pandas.Index(self.time_s, name="time_s"), columns=self.names
        )


@dataclass(frozen=True, eq=False)
class Parameter:
    """The estimates of one parameter, by window.

    value, std_error: float64, shape (windows,), in `unit`; NaN where it is not observable.
    reason: uint8, shape (windows,), see REASON.
    """

    name: str
    unit: str
    value: npt.NDArray[np.float64]
    std_error: npt.NDArray[np.float64]
    reason: npt.NDArray[np.uint8]

    @property
    def observable(self) -> npt.NDArray[np.bool_]:
        """True in the windows in which the parameter has a value. Shape (windows,)."""
        return self.reason == 0


@dataclass(frozen=True, eq=False)
class Estimates:
    """Window estimates of stiffness and damping. estimates["kx_1_y1"] is one parameter.

    parameters, units: name and SI unit of each parameter: N/m, N*s/m, N/(rad*m), N*s/(rad*m).
    window_start_us, window_end_us: int64, shape (windows,), us of sensor time.
    sequence: int64, shape (windows,), number of the window.
    status: uint8, shape (windows,), see STATUS.
    rows: int32, shape (windows,), sample sets in the window.
    residual_ratio: float64, shape (windows,), rms residual over rms response.
    value, std_error: float64, shape (windows, parameters), SI; one standard deviation. NaN where
        a parameter is not observable.
    reason: uint8, shape (windows, parameters), see REASON.
    notes: what the program tells a person about the input.
    """

    parameters: list[str]
    units: list[str]
    window_start_us: npt.NDArray[np.int64]
    window_end_us: npt.NDArray[np.int64]
    sequence: npt.NDArray[np.int64]
    status: npt.NDArray[np.uint8]
    rows: npt.NDArray[np.int32]
    residual_ratio: npt.NDArray[np.float64]
    value: npt.NDArray[np.float64]
    std_error: npt.NDArray[np.float64]
    reason: npt.NDArray[np.uint8]
    notes: list[str] = field(default_factory=list)

    @property
    def window_end_s(self) -> npt.NDArray[np.float64]:
        """End of each window, s of sensor time. Shape (windows,)."""
        return self.window_end_us / 1e6

    @property
    def observable(self) -> npt.NDArray[np.bool_]:
        """True where a parameter has a value. Shape (windows, parameters)."""
        return self.reason == 0

    def __len__(self) -> int:
        return len(self.window_end_us)

    def __getitem__(self, name: str) -> Parameter:
        """Returns the estimates of one parameter, without a copy."""
        if name not in self.parameters:
            raise KeyError(name)
        at = self.parameters.index(name)
        return Parameter(
            name, self.units[at], self.value[:, at], self.std_error[:, at], self.reason[:, at]
        )

    def to_pandas(self) -> pandas.DataFrame:
        """Returns a DataFrame with window_end_s as its index.

        The columns are those of `framewatch replay --out estimates.csv`: status, and for each
        parameter its name, name.std_error and name.observable. Needs pandas.
        """
        import pandas

        columns: dict[str, Any] = {"status": np.array(STATUS, dtype=object)[self.status]}
        for name in self.parameters:
            one = self[name]
            columns[name] = one.value
            columns[name + ".std_error"] = one.std_error
            columns[name + ".observable"] = one.observable
        return pandas.DataFrame(columns, index=pandas.Index(self.window_end_s, name="window_end_s"))

    @classmethod
    def _of(
        cls, parameters: list[str], units: list[str], arrays: dict[str, Any],
        notes: Optional[list[str]] = None,
    ) -> Estimates:
        return cls(parameters, units, **arrays, notes=notes or [])
