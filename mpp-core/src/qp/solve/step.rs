//! One step of the method: from one event to the next.

use super::direction::{Direction, Stand};
use super::{Active, Entering, Solver, TOLERANCE};
use crate::qp::Status;
use crate::qp::condense::Condensed;
use crate::qp::controls::{CONTROLS, dot};
use crate::qp::excess::most_violated;
use crate::qp::factor::CAPACITY;
use crate::qp::rows::RowPattern;

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
    /// One step of the method: from one event to the next.
    pub(super) fn step(&mut self, shared: &Condensed) -> Option<Status> {
        let mut entering = match self.entering.take() {
            Some(entering) => entering,
            None => match self.select(shared) {
                Ok(entering) => entering,
                Err(status) => return Some(status),
            },
        };
        let mut direction = self.direction(&entering.row, entering.norm, &self.products);
        let mut full = (entering.violation / direction.complement).max(0.0);
        let mut touches = false;
        let rise = 0.5 * entering.violation * full;
        if direction.complement <= 0.0 || rise > self.absurd_rise {
            self.refresh(shared, Some(&entering.row));
            entering.violation = self.violation(&entering.row);
            let stand = self.resolve(shared, &entering, &mut direction);
            touches = stand == Stand::Touches;
            full = match stand {
                Stand::Apart(length) => length.max(0.0),
                Stand::Touches | Stand::Contradicts => f64::INFINITY,
            };
        }
        let (event, length) = self.first_event(&entering.row, &direction.rates, full);
        if length == f64::INFINITY {
            return if touches {
                self.touch(entering.row, &mut direction)
            } else {
                Some(self.contradiction(shared, &entering.row, &direction.rates))
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

    /// Selects the row that enters next. The error is the status of a solver that ends here.
    fn select(&mut self, shared: &Condensed) -> Result<Entering, Status> {
        self.refresh(shared, None);
        let by_effort = self.problem.penalty.is_none();
        let worst = most_violated(
            &self.outputs,
            &self.open,
            &shared.prices,
            by_effort,
            self.attitude_rows,
        );
        let row = worst.ok_or(Status::Optimal)?;
        let pattern = RowPattern::of(row).ok_or(Status::NumericalFailure)?;
        let active = Active {
            row,
            pattern,
            multiplier: 0.0,
            yielded: false,
        };
        Ok(Entering {
            violation: self.violation(&active),
            norm: meet(shared, &active, &self.active, &mut self.products),
            row: active,
        })
    }

    /// Handles a row that depends on the active rows and holds together with them up to rounding. The solver
    /// skips such a row. If the row already has a multiplier, it becomes active instead.
    fn touch(&mut self, entering: Active, direction: &mut Direction) -> Option<Status> {
        if entering.multiplier > 0.0 {
            let floor = FLOOR * direction.norm;
            direction.complement = direction.complement.max(floor);
            return self.activate(entering, direction);
        }
        let open = self.open.0.get_mut(entering.row)?;
        *open = f64::INFINITY;
        None
    }

    /// The direction of a step for a row, from its squared norm and its products with the active rows.
    fn direction(&self, own: &Active, norm: f64, products: &[f64; CAPACITY]) -> Direction {
        let mut direction = Direction {
            products: *products,
            rates: [0.0; CAPACITY],
            norm,
            complement: 0.0,
            slope: 0.0,
        };
        let Direction {
            products, rates, ..
        } = &mut direction;
        self.factor.forward(products);
        let known = products.iter().take(self.active.len());
        let mut squares = 0.0;
        for (rate, product) in rates.iter_mut().zip(known) {
            *rate = *product;
            squares += product * product;
        }
        self.factor.backward(rates);
        let rest = norm - squares;
        direction.complement = self.complement(own, norm, rest);
        direction.slope = rest + self.elasticity(own);
        direction
    }

    /// The Schur complement of a row with the norm `norm` of which `rest` does not depend on the active rows.
    fn complement(&self, own: &Active, norm: f64, rest: f64) -> f64 {
        if self.is_soft(own.row) {
            rest.max(FLOOR * norm) + self.elasticity(own)
        } else if rest > DEPENDENT * norm {
            rest
        } else {
            0.0
        }
    }

    /// Excess of a row over its bound, less the amount by which the row yields at its multiplier.
    pub(super) fn violation(&self, own: &Active) -> f64 {
        let bound = self
            .problem
            .bounds
            .0
            .get(own.row)
            .copied()
            .unwrap_or(f64::INFINITY);
        let allowed = match self.problem.penalty {
            Some(penalty) if own.yielded => (own.multiplier - penalty.linear) / penalty.quadratic,
            _ => 0.0,
        };
        own.pattern.value(&self.outputs) - bound - allowed
    }

    /// The first event while the entering multiplier grows, and the length of the step to it.
    fn first_event(&self, entering: &Active, rates: &[f64; CAPACITY], full: f64) -> (Event, f64) {
        let mut first = (Event::Enter, full);
        let mut consider = |event, length: f64| {
            if length < first.1 {
                first = (event, length.max(0.0));
            }
        };
        let price = |row| match self.problem.penalty {
            Some(penalty) if self.is_soft(row) => penalty.linear,
            _ => f64::INFINITY,
        };
        if !entering.yielded {
            consider(
                Event::EnteringYields,
                price(entering.row) - entering.multiplier,
            );
        }
        for (index, (active, rate)) in self.active.iter().zip(rates).enumerate() {
            let to_price = active.multiplier - price(active.row);
            if *rate > 0.0 && active.yielded {
                consider(Event::Toggle(index), to_price / rate);
            } else if *rate > 0.0 {
                consider(Event::Leave(index), active.multiplier / rate);
            } else if *rate < 0.0 && !active.yielded {
                consider(Event::Toggle(index), to_price / rate);
            }
        }
        first
    }

    /// Moves the multipliers: `lambda_p += t`, `lambda_A -= t r`. The controls follow when they are needed.
    fn move_by(&mut self, length: f64, direction: &Direction, entering: &mut Entering) {
        for (active, rate) in self.active.iter_mut().zip(&direction.rates) {
            // Rounding may take the multiplier of a row that leaves below zero.
            active.multiplier = (active.multiplier - length * rate).max(0.0);
        }
        entering.row.multiplier += length;
        entering.violation -= length * direction.slope;
        self.stale = true;
    }

    /// Computes controls, trajectory and outputs of the present multipliers, if they have changed.
    fn refresh(&mut self, shared: &Condensed, entering: Option<&Active>) {
        if self.stale {
            self.normalised = self.controls(shared, entering);
            self.follow(shared);
            self.stale = false;
        }
    }

    fn apply(
        &mut self,
        shared: &Condensed,
        event: Event,
        mut entering: Entering,
        direction: &Direction,
    ) -> Option<Status> {
        let active = self.active.len();
        match event {
            Event::Enter => {
                return self.activate(entering.row, direction);
            }
            Event::EnteringYields => entering.row.yielded = true,
            Event::Leave(index) => {
                self.deactivate(index);
                self.move_last(index, active);
            }
            Event::Toggle(index) => {
                if let Some(mut row) = self.deactivate(index) {
                    row.yielded = !row.yielded;
                    let mut products = [0.0; CAPACITY];
                    let norm = meet(shared, &row, &self.active, &mut products);
                    let failed = self.activate(row, &self.direction(&row, norm, &products));
                    if failed.is_some() {
                        return failed;
                    }
                }
                self.move_last(index, active);
            }
        }
        self.entering = Some(entering);
        None
    }

    /// Moves the product with an active row behind those with the others, as the row itself moves or leaves.
    fn move_last(&mut self, index: usize, active: usize) {
        let from_index = self.products.get_mut(index..active);
        if let Some(from_index) = from_index.filter(|products| !products.is_empty()) {
            from_index.rotate_left(1);
        }
    }

    fn activate(&mut self, row: Active, direction: &Direction) -> Option<Status> {
        let Direction {
            products,
            complement,
            ..
        } = direction;
        let room = self.active.push(row).is_ok() && self.factor.append(products, *complement);
        if let Some(open) = self.open.0.get_mut(row.row) {
            *open = f64::INFINITY;
        }
        (!room).then_some(Status::IterationLimit)
    }

    fn deactivate(&mut self, index: usize) -> Option<Active> {
        let from_index = self
            .active
            .get_mut(index..)
            .filter(|rows| !rows.is_empty())?;
        from_index.rotate_left(1);
        let removed = self.active.pop()?;
        self.factor.remove(index);
        let bound = self.problem.bounds.0.get(removed.row);
        if let (Some(open), Some(bound)) = (self.open.0.get_mut(removed.row), bound) {
            *open = *bound + TOLERANCE;
        }
        Some(removed)
    }
}

/// Computes the products of a row's response with those of the active rows. Returns its squared norm.
fn meet(
    shared: &Condensed,
    own: &Active,
    active: &[Active],
    products: &mut [f64; CAPACITY],
) -> f64 {
    let mut normal = [0.0; CONTROLS];
    shared.add_normal(&mut normal, &own.pattern, 1.0);
    for (product, active) in products.iter_mut().zip(active) {
        *product = shared.change(&active.pattern, &normal);
    }
    dot(&normal, &normal)
}
