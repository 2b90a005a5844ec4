//! `params`: the parameters of a preset.

use super::{FAILURE, Failure, data};
use crate::ground::param_file;
use crate::scenario::{Preset, Scenario};
use flight_node::parameters::{PARAMETERS, Parameter, Tuning};

#[derive(Clone, Debug, clap::Args)]
pub(super) struct ParamsArgs {
    /// Whose values
    #[arg(long, value_enum, default_value_t = Preset::Flight)]
    preset: Preset,
    /// Print unit, range and whether it can change in flight, too
    #[arg(long)]
    long: bool,
}

pub(super) fn run(args: &ParamsArgs) -> Result<u8, Failure> {
    let tuning = Tuning::new(&Scenario::new(args.preset, 0).configure())
        .map_err(|why| Failure::new(FAILURE, format!("{why:?}")))?;
    if args.long {
        for (name, value) in param_file::values(&tuning) {
            let parameter = PARAMETERS.iter().find(|parameter| parameter.name == name);
            data(format_args!(
                "{}",
                parameter.map_or(String::new(), |p| line(p, value))
            ));
        }
    } else {
        data(param_file::format(&tuning).trim_end());
    }
    Ok(0)
}

/// A line that is still one of a parameter file.
fn line(parameter: &Parameter, value: f64) -> String {
    let [least, most] = parameter.range;
    let when = if parameter.in_flight {
        "in flight"
    } else {
        "before the flight"
    };
    format!(
        "{:16},{value:<22} # [{}] {least} to {most}, {when}",
        parameter.name, parameter.unit
    )
}
