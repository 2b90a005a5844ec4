//! One step of the method: from one event to the next.

use super::super::controls::add_all;
use super::direction::{Direction, Stand};
use super::{Active, Condensed, Entering, Solver, Stands};
use crate::qp::Status;

/// Share of a row's own norm below which its Schur complement is zero up to rounding. The row then
/// depends on the active rows.
const DEPENDENT: f64 = 1e-10;

/// Least Schur complement of soft rows and of hard rows that touch, as a share of the row's own norm. It
/// acts as a small elasticity, which lets such a row yield a little and so separates it from the others.
const FLOOR: f64 = 1e-12;

/// The event that ends a step.
#[derive(Clone, Copy)]
enum Event {
    /// The entering row is tight.
    Enter,
    /// The entering row reached its linear price.
    EnteringYields,
    /// An active row's multiplier reached zero.
    Leave(usize),
    /// An active row's multiplier reached its linear price, from below or from above.
    Toggle(usize),
}

impl Solver {
    /// A part of a step of the method, which goes from one event to the next. Only blocks take more than one part.
    pub(super) fn step(&mut self, shared: &Condensed) -> Option<Status> {
        if matches!(self.stands, Stands::Settling(_)) {
            return self.settle_block(shared);
        }
        let mut entering = match core::mem::replace(&mut self.stands, Stands::Free) {
            Stands::Entering(entering) => entering,
            stands => {
                let (row, violation) = if let Stands::TakingUp(row, violation, from) = stands {
                    if self.take_up_rows(shared, (row, violation), from) {
                        return None;
                    }
                    (row, violation)
                } else {
                    let (row, violation) = match self.select(shared) {
                        Ok(selected) => selected,
                        Err(status) => return Some(status),
                    };
                    if self.begin_block(shared, row, violation) {
                        return None;
                    }
                    (row, violation)
                };
                self.meet(shared, row, violation)
            }
        };
        let mut direction = self.direction(&entering.row, entering.norm);
        let mut full = (entering.violation / direction.complement).max(0.0);
        let mut touches = false;
        let rise = 0.5 * entering.violation * full;
        // A row leaves before it matters how far the entering row is apart from the others.
        let least = if direction.complement > 0.0 {
            full
        } else {
            entering.violation / (DEPENDENT * entering.norm)
        };
        let doubtful = (direction.complement <= 0.0 || rise > self.absurd_rise) && {
            let (event, length) = self.first_event(&entering.row, least);
            let cheap = length * entering.violation < self.absurd_rise;
            !(cheap && matches!(event, Event::Leave(_)))
        };
        if !doubtful && direction.complement <= 0.0 {
            full = least;
        }
        if doubtful {
            self.refresh_exactly(shared, Some(&entering.row));
            entering.violation = self.violation(&entering.row);
            let stand = self.resolve(shared, &entering, &mut direction);
            touches = stand == Stand::Touches;
            full = match stand {
                Stand::Apart(length) => length.max(0.0),
                Stand::Touches | Stand::Contradicts => f64::INFINITY,
            };
        }
        let (event, length) = self.first_event(&entering.row, full);
        if length == f64::INFINITY {
            return if touches {
                self.touch(entering.row, &mut direction)
            } else {
                Some(self.contradiction(shared, &entering.row))
            };
        }
        self.dual += length * (entering.violation - 0.5 * length * direction.complement);
        self.move_by(length, &direction, &mut entering);
        if self.dual > self.problem.cost_limit {
            return Some(Status::Dominated);
        }
        // The factor is 2, because the dual starts from the cost of the optimum without rows, and
        // because rounding must not decide.
        if self.dual > 2.0 * self.absurd_rise {
            return Some(self.excessive_multipliers(shared, &entering.row));
        }
        if !self.dual.is_finite() {
            return Some(Status::NumericalFailure);
        }
        self.apply(shared, event, entering, &direction)
    }

    /// Handles a row that depends on the active rows and holds together with them up to rounding. The solver
    /// skips such a row. If the row already has a multiplier, it becomes active instead.
    fn touch(&mut self, entering: Active, direction: &mut Direction) -> Option<Status> {
        if entering.multiplier > 0.0 {
            let floor = FLOOR * direction.norm;
            direction.complement = direction.complement.max(floor);
            return self.activate(entering, direction.complement);
        }
        let open = self.open.0.get_mut(entering.row)?;
        *open = f64::INFINITY;
        None
    }

    /// The direction of a step for a row, from its squared norm and its products with the active rows.
    fn direction(&mut self, own: &Active, norm: f64) -> Direction {
        let known = self.products.iter().take(self.active.len());
        let mut squares = 0.0;
        for (rate, product) in self.rates.iter_mut().zip(known) {
            *rate = *product;
            squares += product * product;
        }
        self.factor.backward(&mut self.rates);
        let rest = norm - squares;
        Direction {
            norm,
            complement: self.complement(own, norm, rest),
            slope: rest + self.elasticity(own),
        }
    }

    /// The Schur complement of a row with the norm `norm` of which `rest` does not depend on the active rows.
    pub(super) fn complement(&self, own: &Active, norm: f64, rest: f64) -> f64 {
        if own.price < f64::INFINITY {
            rest.max(FLOOR * norm) + self.elasticity(own)
        } else if rest > DEPENDENT * norm {
            rest
        } else {
            0.0
        }
    }

    /// The first event while the entering multiplier grows, and the length of the step to it.
    fn first_event(&self, entering: &Active, full: f64) -> (Event, f64) {
        let mut first = (Event::Enter, full);
        if !entering.yielded {
            let length = entering.price - entering.multiplier;
            if length < first.1 {
                first = (Event::EnteringYields, length.max(0.0));
            }
        }
        for (index, (active, rate)) in self.active.iter().zip(&self.rates).enumerate() {
            if *rate > 0.0 {
                // Compared by products, because divisions take long.
                let distance = if active.yielded {
                    active.multiplier - active.price
                } else {
                    active.multiplier
                };
                if distance < first.1 * rate {
                    let event = if active.yielded {
                        Event::Toggle(index)
                    } else {
                        Event::Leave(index)
                    };
                    first = (event, (distance / rate).max(0.0));
                }
            } else if *rate < 0.0 && !active.yielded {
                let distance = active.multiplier - active.price;
                if distance > first.1 * rate {
                    first = (Event::Toggle(index), (distance / rate).max(0.0));
                }
            }
        }
        first
    }

    /// Moves the multipliers, `lambda_p += t`, `lambda_A -= t r`, and the controls with them.
    fn move_by(&mut self, length: f64, direction: &Direction, entering: &mut Entering) {
        for (active, rate) in self.active.iter_mut().zip(&self.rates) {
            // Rounding may take the multiplier of a row that leaves below zero.
            active.multiplier = (active.multiplier - length * rate).max(0.0);
        }
        entering.row.multiplier += length;
        entering.violation -= length * direction.slope;
        add_all(&mut self.normalised, &self.rest.0, -length);
        self.stale = true;
        self.rolled = false;
        self.drift += 1;
    }

    /// Computes trajectory and outputs of the present controls, if they have changed.
    pub(super) fn refresh(&mut self, shared: &Condensed) {
        if self.stale {
            if self.attitude_rows {
                self.follow(shared);
                self.rolled = true;
            } else {
                shared.respond(&self.free, &self.normalised, &mut self.outputs);
            }
            self.stale = false;
        }
    }

    /// Computes controls, trajectory and outputs of the present multipliers.
    pub(super) fn refresh_exactly(&mut self, shared: &Condensed, entering: Option<&Active>) {
        if self.drift > 0 {
            self.normalised = self.controls(shared, entering);
            self.stale = true;
            self.rolled = false;
            self.drift = 0;
        }
        self.refresh(shared);
    }

    fn apply(
        &mut self,
        shared: &Condensed,
        event: Event,
        mut entering: Entering,
        direction: &Direction,
    ) -> Option<Status> {
        match event {
            Event::Enter => {
                return self.activate(entering.row, direction.complement);
            }
            Event::EnteringYields => entering.row.yielded = true,
            Event::Leave(index) => {
                self.deactivate(index);
            }
            Event::Toggle(index) => {
                if let Some(mut row) = self.deactivate(index) {
                    row.yielded = !row.yielded;
                    if !self.append(shared, row, None) {
                        return Some(Status::IterationLimit);
                    }
                    // The entering row meets the new direction.
                    let last = self.active.len() - 1;
                    if let (Some(direction), Some(product)) =
                        (self.factor.direction(last), self.products.get_mut(last))
                    {
                        *product = shared.change(&entering.row.pattern, direction);
                        add_all(&mut self.rest.0, direction, -*product);
                    }
                }
            }
        }
        self.stands = Stands::Entering(entering);
        None
    }
}
