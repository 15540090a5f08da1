# SPDX-License-Identifier: MIT
"""Draw all streams of a run over time, with gaps and events marked."""

from collections import Counter
from collections.abc import Sequence
from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from model.arrays import Array
from model.counted import counted
from zebro_lab.files.source_names import is_simulated
from zebro_lab.plots.sheet import CYCLE, RED, new_figure, styled
from zebro_lab.runs.signals import Event, Panel, RunSignals

_COLUMNS: Final = 1500
"""Number of intervals of a long curve; only the extremes of each interval are drawn."""
_MOST_EVENTS: Final = 10
_LONGEST_TEXT: Final = 90


@styled
def raw_streams(run: RunSignals, at: Sequence[float] = ()) -> Figure:
    """Draw every stream of a run, one panel per quantity, above them the events; return the figure.

    Args:
        run: Signals, with one panel or more.
        at: Times to mark in every panel [s].
    """
    drawn = run.panels
    rows = len(drawn) + bool(run.events)
    title = f"{run.name}: raw streams, {run.state}"
    events = min(len(run.events), _MOST_EVENTS + 1)
    heights = [0.25 + 0.2 * events] * bool(run.events) + [1.4] * len(drawn)
    figure = new_figure(title, is_simulated(run.source), width=10.0, height=1.0 + sum(heights))
    grid = figure.subplots(rows, 1, sharex=True, squeeze=False, height_ratios=heights)[:, 0]
    if run.events:
        _list_events(grid[0], run.events)
    for axes, panel in zip(grid[len(grid) - len(drawn) :], drawn, strict=True):
        _draw_panel(axes, panel)
        for event in run.events:
            if event.warning:
                axes.axvline(event.t, color=RED, lw=0.7, ls=":")
        _mark(axes, at)
    begin = min(panel.t[0] for panel in drawn)
    end = max(panel.t[-1] for panel in drawn)
    grid[-1].set(xlabel="time of the run [s]", xlim=(begin, end if end > begin else begin + 1))
    return figure


def extremes(t: Array, values: Array, columns: int) -> tuple[Array, Array]:
    """Downsample a curve to the minimum and maximum of each interval, so that spikes are kept.

    Args:
        t: Times, shape (n,) [s].
        values: Values, shape (n,); NaN is compared as 0, and returned where it is chosen.
        columns: Number of intervals of n // columns samples; the samples behind them are kept.

    Returns:
        Times and values in time order, each of shape (2 columns + n % columns,); as given if n is
        at most 2 columns.

    >>> t = np.arange(1000.0)
    >>> float(extremes(t, np.where(t == 503, 9.0, 0.0), 10)[1].max())
    9.0
    """
    if len(t) <= 2 * columns:
        return t, values
    length = len(t) // columns
    # argmin and argmax would choose a NaN wherever there is one, and hide the extremes
    parts = np.nan_to_num(values[: length * columns]).reshape(columns, length)
    first = np.arange(columns) * length
    chosen = np.sort(np.stack([parts.argmin(axis=1), parts.argmax(axis=1)]) + first, axis=0)
    at = np.append(chosen.T.ravel(), np.arange(length * columns, len(t)))
    return t[at], values[at]


def _draw_panel(axes: Axes, panel: Panel) -> None:
    """Draw the curves of a panel without lines across gaps, and a red bar over each gap."""
    for (name, line), colour in zip(panel.lines.items(), CYCLE, strict=False):
        t, values = extremes(panel.t, np.asarray(line, dtype=float), _COLUMNS)
        axes.plot(*_broken(t, values, panel.gaps), color=colour, lw=0.7, label=name)
    spans = [(begin, max(end - begin, 1e-9)) for begin, end in panel.gaps.tolist()]
    axes.broken_barh(
        spans, (0, 1), transform=axes.get_xaxis_transform(), facecolor=RED, edgecolor=RED,
        alpha=0.25, lw=0.5,
    )  # fmt: skip
    gaps = f", {counted(len(spans), 'gap')}" if spans else ""
    simulated = " (simulated)" if panel.simulated else ""
    axes.set_title(f"{panel.title}{simulated}, {counted(len(panel.t), 'sample')}{gaps}", loc="left")
    axes.set_ylabel(f"[{panel.unit}]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=1.0)
    axes.grid(color="0.92", lw=0.6)


def _mark(axes: Axes, at: Sequence[float]) -> None:
    """Draw a line at each time, with the time at its upper end."""
    for t in at:
        axes.axvline(t, color="black", lw=0.8)
        axes.annotate(
            f"{t:g} s", (t, 1.0), xycoords=("data", "axes fraction"), xytext=(2, -2),
            textcoords="offset points", ha="left", va="top", fontsize=7,
        )  # fmt: skip


def _broken(t: Array, values: Array, gaps: Array) -> tuple[Array, Array]:
    """Insert a NaN value at the middle of each gap, so that no line is drawn across it."""
    at = np.searchsorted(t, gaps[:, 0], side="right")
    return np.insert(t, at, gaps.mean(axis=1)), np.insert(values, at, np.nan)


def _list_events(axes: Axes, events: Sequence[Event]) -> None:
    """List the events of a run by rows, each with a mark at its time; warnings are red.

    At most `_MOST_EVENTS` are listed (`_chosen`), texts of late events to the left of the mark.
    """
    shown = _chosen(events)
    middle = (events[0].t + events[-1].t) / 2
    for row, event in enumerate(shown):
        colour = RED if event.warning else "0.3"
        late = event.t > middle
        axes.plot(event.t, row, marker="|", ms=7, color=colour)
        axes.annotate(
            event.text[:_LONGEST_TEXT], (event.t, row), xytext=(-6 if late else 6, 0),
            textcoords="offset points", ha="right" if late else "left", va="center", fontsize=9,
            color=colour, annotation_clip=False,
        )  # fmt: skip
    more = len(events) - len(shown)
    axes.set_title(f"events{f' ({more} more in log.mcap)' if more else ''}", loc="left")
    axes.set(ylim=(len(shown) - 0.3, -0.7), yticks=[])
    for side in ("left", "bottom"):
        axes.spines[side].set_visible(False)
    axes.tick_params(axis="x", length=0, labelbottom=False)


def _chosen(events: Sequence[Event]) -> list[Event]:
    """Select at most `_MOST_EVENTS` events to label, in time order.

    The first and the last event are always kept. The events between are ranked by how often their
    text occurred before, least first, then warnings first, then by time.
    """
    if len(events) <= _MOST_EVENTS:
        return list(events)
    seen: Counter[str] = Counter()
    ranked = []
    for event in events[1:-1]:
        seen[event.text] += 1
        ranked.append((seen[event.text], not event.warning, event.t, event))
    kept = [event for *_, event in sorted(ranked, key=lambda each: each[:3])[: _MOST_EVENTS - 2]]
    return [events[0], *sorted(kept, key=lambda event: event.t), events[-1]]
