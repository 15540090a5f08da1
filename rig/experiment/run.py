# SPDX-License-Identifier: MIT
"""Run a plan on a bench: zero, load, settle, record, check, repeat; and carry out stops."""

from collections.abc import Collection
from dataclasses import InitVar, dataclass
from typing import Final

from rig.clock import SYSTEM_CLOCK, Clock
from rig.errors import ProtocolError
from rig.experiment.acquire import PERIOD, GuardedAcquisition
from rig.experiment.bench import Bench
from rig.experiment.condition import Condition, RigState
from rig.experiment.control import Control
from rig.experiment.load import LoadSetter
from rig.experiment.measure import record, settle, undoubted_zero
from rig.experiment.plan import Plan
from rig.experiment.readings import Batch
from rig.experiment.sink import ExperimentWatcher, RunSink, RunStart, SinkFailed
from rig.experiment.steps import Point, Step, Tare, estimate, require_allowed, spell_out, steps_left
from rig.experiment.verdict import PointVerdict, contradiction, judge_point
from rig.safety import StopCategory, StopRequested
from rig.slip_rig.decode import Zero

REST_TIMEOUT: Final = 5.0
"""Timeout for the discs to stand after their set-points are zero [s]."""
UNLOADED: Final = Zero(0.0, 0.0, 0.0)  # subtracted until the first zero has been measured [N]


@dataclass(frozen=True)
class RunOutcome:
    """Outcome of a run.

    Attributes:
        reason: `completed`, or category and reason of the stop that ended the run.
        finished: Number of accepted points, those of an earlier run included.
        refused: Numbers of the points of which every attempt was rejected.
        attempts: Number of attempts at points in this run.
        source: Source of the samples, "real" or "sim:WHAT".
    """

    reason: str
    finished: int
    refused: tuple[int, ...]
    attempts: int
    source: str

    @property
    def completed(self) -> bool:
        """Return whether the plan was carried out to its end; points may have been refused."""
        return self.reason == "completed"


def run_plan(
    plan: Plan,
    *,
    bench: Bench,
    load: LoadSetter,
    sink: RunSink,
    control: Control,
    watcher: ExperimentWatcher | None = None,
    clock: Clock = SYSTEM_CLOCK,
    period: float = PERIOD,
    done: Collection[int] = (),
    zero: Zero | None = None,
) -> RunOutcome:
    """Run a plan; in the end the drives are de-energised and the sink has stored the reason.

    Args:
        plan: The plan.
        bench: The rig, not yet entered.
        load: Setter of the normal force.
        sink: Recorder of samples and events.
        control: Mailbox for pauses, notes and stops.
        watcher: Progress display; None shows nothing.
        clock: Host time.
        period: Polling period of the rig [s].
        done: Numbers of the points that an earlier run finished; they are left out.
        zero: Last zero of the load cell in an earlier run; None without one.

    Returns:
        The outcome of a run that was completed or stopped on request.

    Raises:
        LimitExceeded: A set-point exceeds a limit, found before motion; or a guard tripped.
        ProfileError: The plan limits a quantity that the rig does not measure.
        SinkFailed, PartFailed: Storing or a thread failed; the discs were ramped to rest first.
        RigError: A guard, device, load or standstill failed; the drives were de-energised at once.
        ProtocolError: An emergency stop is latched, or a zero has too few readings.
    """
    require_allowed(plan, bench.profile)
    if control.stop.latched:
        raise ProtocolError("an emergency stop is latched; inspect the rig, then reset the stop")
    watcher, known = watcher or ExperimentWatcher(), zero or bench.profile.unloaded
    run = _Run(plan, bench, load, sink, control, watcher, clock, known, period, done)
    return run.go()


@dataclass
class _Run:
    """State and steps of one run of a plan; see `run_plan`."""

    _plan: Plan
    _bench: Bench
    _load: LoadSetter
    _sink: RunSink
    _control: Control
    _watcher: ExperimentWatcher
    _clock: Clock
    _zero: Zero | None
    period: InitVar[float]
    done: InitVar[Collection[int]]

    def __post_init__(self, period: float, done: Collection[int]) -> None:
        self._acquire = GuardedAcquisition(
            self._bench, limits=self._plan.limits, control=self._control, sink=self._sink,
            clock=self._clock, period=period,
        )  # fmt: skip
        self._steps = spell_out(self._plan)
        points = {step.number for step in self._steps if isinstance(step, Point)}
        self._points = len(points)
        self._done = points & set(done)
        self._past = set(self._done)  # steps that need no time any more: refused points, too
        self._loaded: float | None = None
        self._recording = False
        self._attempts = 0
        self._refused: list[int] = []
        self._verdicts: dict[Point, PointVerdict] = {}

    def go(self) -> RunOutcome:
        """Run the plan; in every case leave the rig de-energised and store the reason."""
        reason = "failed"
        try:
            self._show(RigState.PREPARING)
            with self._bench:
                reason = self._execute_plan()
        except BaseException as error:
            reason = f"{type(error).__name__}: {error}"
            raise
        finally:
            self._acquire.energised = False  # leaving a bench de-energises it
            self._load.halt()
            failed = self._finish(reason)
        if failed is not None:
            raise failed
        refused, source = tuple(self._refused), self._bench.source
        return RunOutcome(reason, len(self._done), refused, self._attempts, source)

    def _execute_plan(self) -> str:
        """Carry out the steps, and a stop that ends the run; return the reason of `RunOutcome`.

        If a part of the run has failed, its `PartFailed` is raised after the stop instead.
        """
        self._sink.event("begin", f"{self._plan.name}, {self._bench.source}")
        if self._plan.limits.guards_off:
            self._sink.event("guards off", self._plan.limits.guards_off_text)
        try:
            self._acquire.arm()
            self._show(RigState.RUNNING)
            for step in steps_left(self._steps, self._done):
                self._carry_out(step)
            self._show(RigState.STOPPING, "the plan is complete")
            self._acquire.come_to_rest(REST_TIMEOUT)
        except StopRequested as asked:
            self._stop(asked)
            if self._control.failure is not None:
                raise self._control.failure from asked
            hardest = self._control.stop.pending  # another stop may have arrived during the ramp
            return str(asked if hardest is None else StopRequested(hardest))
        except SinkFailed as failed:
            self._show(RigState.STOPPING, str(failed))
            self._acquire.ignore_stops(StopCategory.SAFE)
            self._acquire.rest_without_sink(REST_TIMEOUT)
            raise
        return "completed"

    def _carry_out(self, step: Step) -> None:
        """Carry out a zero or a point; hold first if paused, and on a soft stop, then repeat it."""
        while True:
            try:
                if self._control.paused:
                    self._hold("pause")
                if isinstance(step, Tare) or self._zero is None:
                    self._tare()
                if isinstance(step, Point):
                    self._measure(step)
            except StopRequested as asked:
                if asked.stop.category is not StopCategory.SOFT:
                    raise
                self._close(str(asked))
                self._load.halt()
                self._loaded = None  # the shaft may have been moved
                self._hold(str(asked))
            else:
                self._past.add(step.number)
                return

    def _hold(self, why: str) -> None:
        """Ramp to standstill and wait, energised, until the run is resumed.

        If that takes longer than the plan's `hold`, a safe stop is requested and raised.
        """
        if self._control.stop.pending is None:
            self._control.stop.request(StopCategory.SOFT, why)  # the next stop is a harder one
        self._acquire.ignore_stops(StopCategory.SOFT)
        self._sink.event("hold", why)
        self._show(RigState.STOPPING, why)
        self._acquire.come_to_rest(REST_TIMEOUT)
        self._show(RigState.HOLDING, why)

        def released(_: Batch) -> bool:
            """Return whether neither a stop nor a pause is pending any more."""
            return self._control.stop.pending is None and not self._control.paused

        if not self._acquire.until(released, self._plan.limits.hold):
            waited = f"held for {self._plan.limits.hold:g} s and not resumed: {why}"
            self._control.stop.request(StopCategory.SAFE, waited)
        self._acquire.ignore_stops(None)
        self._acquire.poll()  # raises if the wait ended in a harder stop
        self._sink.event("go on", why)
        self._show(RigState.RUNNING)

    def _show(self, state: RigState, why: str = "") -> None:
        """Pass the state to the watcher and, unless the run is RUNNING, to the status line."""
        pending = self._control.stop.pending
        condition = Condition(
            state, self._acquire.energised, why, None if pending is None else pending.category,
            self._plan.limits.hold,
        )  # fmt: skip
        if state is not RigState.RUNNING:
            self._control.status = f"{condition.headline}; {condition.keys}"
        self._watcher.changed(condition)

    def _tare(self) -> None:
        """Unload and take the zero of the load cell; a person confirms one that is in doubt."""
        self._announce("zero of the load cell")
        by_hand = self._set_load(0.0)
        self._zero = undoubted_zero(
            self._acquire, self._plan.controls, self._sink, self._zero,
            ask=lambda question: by_hand and self._set_load(0.0, question),
        )  # fmt: skip

    def _set_load(self, target: float, question: str = "") -> bool:
        """Have a normal force set, or a question confirmed [N]; return whether one was asked."""
        if target == self._loaded and not question:
            return False
        self._loaded = None
        self._acquire.come_to_rest(REST_TIMEOUT)
        if prompt := self._load.request(target):
            prompt = question or prompt
            self._control.status = prompt
            self._sink.event("prompt", prompt)
        zero = self._zero or UNLOADED

        def is_set(batch: Batch) -> bool:
            """Show the mean normal force of a batch, and ask the setter whether it is reached."""
            if not len(batch.normal):
                return False
            normal = float(batch.normal.mean()) - zero.normal
            if prompt:
                self._watcher.prompt(prompt, normal=normal)
            return self._load.follow(normal)

        self._acquire.until(is_set, float("inf"))
        self._loaded = target
        return bool(prompt)

    def _measure(self, point: Point) -> None:
        """Set the load and measure a point until an attempt is accepted, or refuse it after all."""
        self._set_load(point.load)
        problems: tuple[str, ...] = ()
        for attempt in range(1, self._plan.accept.attempts + 1):
            verdict = self._attempt(point, attempt)
            self._watcher.judged(point, verdict, attempt=attempt)
            if verdict.accepted:
                self._done.add(point.number)
                return
            problems = verdict.problems
        self._refused.append(point.number)
        self._sink.event("refused", f"{point.label}: {'; '.join(problems)}")

    def _attempt(self, point: Point, attempt: int) -> PointVerdict:
        """Settle the discs at a point, record it once, and judge the recording."""
        self._announce(point.label if attempt == 1 else f"{point.label}, attempt {attempt}")
        self._attempts += 1
        zero = self._zero or UNLOADED
        settled = settle(self._acquire, self._plan, point, zero)
        self._recording = True  # set before opening, which may fail after the run has begun
        off = self._plan.limits.guards_off_text
        self._sink.open_run(RunStart(point, attempt, self._clock.now(), zero, off))
        readings = record(self._acquire, self._sink, self._plan, point, zero, clock=self._clock)
        verdict = judge_point(
            readings, point, self._plan.accept, settled=settled,
            duration=self._plan.points.duration, profile=self._bench.profile,
        )  # fmt: skip
        if verdict.accepted and (warning := contradiction(point, verdict, self._verdicts)):
            self._sink.event("warning", warning)
            self._watcher.notice(warning)
        self._verdicts[point] = verdict
        self._close("completed", verdict)
        return verdict

    def _announce(self, what: str) -> None:
        """Show that a step begins, with the progress of the run and the estimated time left."""
        if self._plan.limits.guards_off:
            what = f"{what} [guards off: {', '.join(self._plan.limits.guards_off)}]"
        left = [step for step in self._steps if step.number not in self._past]
        seconds = estimate(self._plan, tuple(left)).seconds
        done = len(self._done)
        self._control.status = f"{what} ({done} of {self._points} points, {seconds:.0f} s left)"
        self._watcher.doing(what, done=done, of=self._points, left=seconds)

    def _stop(self, asked: StopRequested) -> None:
        """De-energise: at once, and latch, for an emergency stop; else after a ramp to rest."""
        if asked.stop.category is StopCategory.EMERGENCY:
            self._acquire.disarm()
            self._sink.latch(asked.stop.reason)
            return
        self._show(RigState.STOPPING, str(asked))
        self._acquire.ignore_stops(asked.stop.category)
        try:
            self._acquire.come_to_rest(REST_TIMEOUT)
        except StopRequested:  # a harder stop
            pass
        except SinkFailed:
            self._acquire.rest_without_sink(REST_TIMEOUT)
            raise
        finally:
            self._acquire.disarm()

    def _close(self, reason: str, verdict: PointVerdict | None = None) -> None:
        """Close the recording of an attempt, if one is open."""
        if self._recording:
            self._recording = False
            self._sink.close_run(verdict, reason=reason)

    def _finish(self, reason: str) -> SinkFailed | None:
        """Store latch and end of the run, show the state; return the last `SinkFailed` or None."""
        stop = self._control.stop.pending
        latched = stop is not None and stop.category is StopCategory.EMERGENCY
        if stop is not None and latched:
            self._sink.latch(stop.reason)  # also one that came with a guard, or during the ramp
        failed = None
        for keep in (self._close, lambda why: self._sink.event("end", why)):
            try:
                keep(reason)
            except SinkFailed as error:
                failed = error
        self._show(RigState.LATCHED if latched else RigState.STOPPED, reason)
        return failed
