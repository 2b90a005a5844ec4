//! Tests of the step that reach into a flight.

use super::{Cycle, Pace, StepTask};
use crate::mail::{Plan, PlanReply};
use crate::out::Frames;
use hil_protocol::{
    ActuatorLimits, Aircraft, Body, Configure, MAX_FRAME, Preset, SensorFrame, encode_body,
};
use mpp_core::planner::{PlanSummary, Verdict};
use mpp_core::trajectory::Trajectory;

const CONFIGURE: Configure = Configure {
    preset: Preset::Flight,
    aircraft: Aircraft::REFERENCE,
    paths: 25,
    seed: 0,
    replan_period_ticks: 100,
    latency_ticks: 50,
    slices_per_tick: 100,
    beams: 100,
    range_max: 45.0,
    altitude: 50.0,
    actuators: ActuatorLimits::NONE,
};

fn tell(task: &mut StepTask, message: &impl Body) {
    for byte in encode_body(message, &mut [0; MAX_FRAME]).unwrap_or_default() {
        task.receive(*byte, |_| {});
    }
}

fn tick(task: &mut StepTask, tick: u32) {
    let (air, position) = (None, None);
    tell(
        task,
        &SensorFrame {
            tick,
            air,
            position,
        },
    );
}

#[test]
fn a_cycle_that_ended_by_a_defect_of_the_planner_is_counted() {
    let mut task = StepTask::new(Pace::RealTime);
    tell(&mut task, &CONFIGURE);
    task.set_up_done(Ok(()), &mut Frames(|_: &[u8]| {}));
    tick(&mut task, 0);
    for (begun, inconsistent, count) in [(1, false, 0), (2, true, 1), (3, true, 2), (4, false, 2)] {
        if let Some(session) = &mut task.session {
            session.cycle = Some(Cycle {
                begun,
                scan: begun,
                due: begun,
                without_scan: false,
            });
        }
        let plan = Plan {
            tick: begun,
            verdict: Verdict::Nothing,
            summary: PlanSummary {
                inconsistent,
                ..PlanSummary::NOTHING
            },
            trajectory: Trajectory::new(),
            seal: Trajectory::new().seal(),
        };
        task.take_reply(PlanReply::Plan(plan), |_| {});
        tick(&mut task, begun);
        let counted = task.health().map(|health| health.planner_inconsistent);
        assert_eq!(counted, Some(count));
    }
}

#[test]
fn a_plan_of_which_a_bit_flipped_on_its_way_is_not_flown() {
    for altered in [false, true] {
        let mut task = StepTask::new(Pace::RealTime);
        tell(&mut task, &CONFIGURE);
        task.set_up_done(Ok(()), &mut Frames(|_: &[u8]| {}));
        tick(&mut task, 0);
        if let Some(session) = &mut task.session {
            session.cycle = Some(Cycle {
                begun: 0,
                scan: 0,
                due: 1,
                without_scan: false,
            });
        }
        let mut trajectory = Trajectory::new();
        let seal = trajectory.seal();
        if altered {
            let height = &mut trajectory.knots[7].state.z;
            *height = f64::from_bits(height.to_bits() ^ 1 << 40);
        }
        let plan = Plan {
            tick: 0,
            verdict: Verdict::Feasible,
            summary: PlanSummary::NOTHING,
            trajectory,
            seal,
        };
        task.take_reply(PlanReply::Plan(plan), |_| {});
        tick(&mut task, 1);
        let health = task.health().copied().unwrap_or_default();
        let told = [
            health.plans_feasible,
            health.plans_refused,
            health.plans_trim_hold,
        ];
        assert_eq!(told, if altered { [0, 1, 1] } else { [1, 0, 0] });
    }
}
