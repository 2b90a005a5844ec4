//! One step of the method: from one event to the next.

use super::{Active, CAPACITY, Solver, TOLERANCE};
use crate::qp::Status;
use crate::qp::condense::Condensed;
use crate::qp::rows::{OUTPUTS, RowPattern, add_scaled, most_violated};

/// Schur complements below this share of the row's own norm are zero but for rounding: the row
/// depends on the active ones.
const DEPENDENT: f64 = 1e-10;

/// Violations of dependent rows up to this [m, rad or N] may be rounding.
const NEGLIGIBLE: f64 = 1e-8;

/// Soft rows are kept apart by this much elasticity: it lets a row give way by 1e-12
/// of what it takes to move it.
const SOFT_FLOOR: f64 = 1e-12;

/// No controls that an aircraft could fly cost this much: where the lower bound of the cost passes
/// it, rows contradict each other but for rounding.
const ABSURD_COST: f64 = 1e12;

/// What ends a step.
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
        let entering = match self.entering.take() {
            Some(entering) => entering,
            None => {
                let (open, pricing) = (&self.open, &shared.pricing);
                let worst = most_violated(&self.outputs, open, pricing, self.attitude_rows);
                let Some(row) = worst else {
                    return Some(Status::Optimal);
                };
                let Some(pattern) = RowPattern::of(row) else {
                    return Some(Status::NumericalFailure);
                };
                Active {
                    row,
                    pattern,
                    multiplier: 0.0,
                    yielded: false,
                }
            }
        };
        let column = entering.pattern.column(&shared.kernel, self.attitude_rows);
        let (products, complement) = self.complement(&column, &entering);
        let mut rates = products;
        self.factor.backward(&mut rates);

        let violation = self.violation(&entering);
        let full = if complement > 0.0 {
            violation / complement
        } else {
            f64::INFINITY
        };
        let (event, length) = self.first_event(&entering, &rates, full.max(0.0));
        if length == f64::INFINITY {
            return self.contradiction(&entering, violation, &rates);
        }
        self.dual += length * (violation - 0.5 * length * complement);
        let entering = self.move_by(shared, length, &rates, &column, entering);
        if self.dual > ABSURD_COST {
            self.certify_by_multipliers(&entering);
            return Some(Status::Infeasible);
        }
        if self.dual > self.problem.cost_limit {
            return Some(Status::Dominated);
        }
        if !self.dual.is_finite() {
            return Some(Status::NumericalFailure);
        }
        self.apply(shared, event, entering, &products, complement)
    }

    /// `L^-1 C K c` and the Schur complement of a row against the active rows; 0 when it depends on
    /// them. `column` is its `K c`.
    fn complement(&self, column: &[f64; OUTPUTS], own: &Active) -> ([f64; CAPACITY], f64) {
        let mut products = [0.0; CAPACITY];
        for (product, active) in products.iter_mut().zip(&self.active) {
            *product = active.pattern.value(column);
        }
        self.factor.forward(&mut products);
        let norm = own.pattern.value(column);
        let explained: f64 = products
            .iter()
            .take(self.active.len())
            .map(|product| product * product)
            .sum();
        let rest = norm - explained;
        let complement = match self.problem.penalty {
            Some(penalty) if self.is_soft(own.row) => {
                let elastic = if own.yielded {
                    1.0 / penalty.quadratic
                } else {
                    0.0
                };
                rest.max(SOFT_FLOOR * norm) + elastic
            }
            _ if rest > DEPENDENT * norm => rest,
            _ => 0.0,
        };
        (products, complement)
    }

    /// How far a row is from where its multiplier wants it.
    fn violation(&self, own: &Active) -> f64 {
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

    /// What happens first while the entering multiplier grows, and how far away it is.
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

    /// Moves multipliers and outputs: `lambda_p += t`, `lambda_A -= t r`,
    /// `y -= t K (c_p - C_A' r)`.
    fn move_by(
        &mut self,
        shared: &Condensed,
        length: f64,
        rates: &[f64; CAPACITY],
        column: &[f64; OUTPUTS],
        mut entering: Active,
    ) -> Active {
        let mut change = [0.0; OUTPUTS];
        let mut add = |(output, factor): (usize, f64)| {
            if let Some(change) = change.get_mut(output) {
                *change += factor;
            }
        };
        for (active, rate) in self.active.iter_mut().zip(rates) {
            let step = length * rate;
            // Rounding may take the multiplier that just left below zero.
            active.multiplier = (active.multiplier - step).max(0.0);
            let RowPattern { first, second } = active.pattern;
            add((first.0, step * first.1));
            add((second.0, step * second.1));
        }
        for (output, column) in self.outputs.iter_mut().zip(column) {
            *output -= length * column;
        }
        let kernel = shared.kernel.as_chunks::<2>().0;
        for ([one, other], factors) in kernel.iter().zip(change.as_chunks::<2>().0) {
            if factors.iter().any(|factor| *factor != 0.0) {
                add_scaled(
                    &mut self.outputs,
                    [one, other],
                    *factors,
                    self.attitude_rows,
                );
            }
        }
        entering.multiplier += length;
        entering
    }

    fn apply(
        &mut self,
        shared: &Condensed,
        event: Event,
        mut entering: Active,
        products: &[f64; CAPACITY],
        complement: f64,
    ) -> Option<Status> {
        match event {
            Event::Enter => {
                return self.activate(entering, products, complement);
            }
            Event::EnteringYields => entering.yielded = true,
            Event::Leave(index) => {
                self.deactivate(index);
            }
            Event::Toggle(index) => {
                if let Some(mut active) = self.deactivate(index) {
                    active.yielded = !active.yielded;
                    let column = active.pattern.column(&shared.kernel, self.attitude_rows);
                    let (products, complement) = self.complement(&column, &active);
                    let failed = self.activate(active, &products, complement);
                    if failed.is_some() {
                        return failed;
                    }
                }
            }
        }
        self.entering = Some(entering);
        None
    }

    fn activate(
        &mut self,
        row: Active,
        products: &[f64; CAPACITY],
        complement: f64,
    ) -> Option<Status> {
        let room = self.active.push(row).is_ok() && self.factor.append(products, complement);
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

    /// A row that depends on the active ones cannot be kept with them: the program is infeasible,
    /// unless rounding may have made the whole violation. Then the row is passed over.
    fn contradiction(
        &mut self,
        entering: &Active,
        violation: f64,
        rates: &[f64; CAPACITY],
    ) -> Option<Status> {
        if violation <= NEGLIGIBLE && entering.multiplier == 0.0 {
            let open = self.open.0.get_mut(entering.row)?;
            *open = f64::INFINITY;
            return None;
        }
        self.certify(entering.row, rates);
        Some(Status::Infeasible)
    }

    /// Records the proof that rows contradict each other: the entering row and the active ones,
    /// whose left-hand sides cancel.
    fn certify(&mut self, entering: usize, rates: &[f64; CAPACITY]) {
        let _ = self.certificate.push((entering, 1.0));
        for (active, rate) in self.active.iter().zip(rates) {
            if *rate != 0.0 {
                let _ = self.certificate.push((active.row, -rate));
            }
        }
    }

    /// Records the multipliers themselves, which prove that no controls of any sensible size keep the
    /// rows.
    fn certify_by_multipliers(&mut self, entering: &Active) {
        let scale = entering.multiplier.max(1.0);
        for active in self.active.iter().chain([entering]) {
            let _ = self
                .certificate
                .push((active.row, active.multiplier / scale));
        }
    }
}
