//! `params`: prints the parameters of a preset.

use super::answer::{Failure, data};
use super::values::preset;
use crate::ground::param_file;
use mpp_node::parameters::{self, PARAMETERS, Parameter, Tuning};
use mpp_sim::scenario::{Preset, Scenario};

#[derive(Clone, Debug, clap::Args)]
#[command(after_help = super::help::PARAMS)]
pub(super) struct ParamsArgs {
    /// Preset whose values are printed
    #[arg(long, value_parser = preset(), default_value_t = Preset::Flight)]
    preset: Preset,
    /// Also print the unit, the range and whether the parameter can change in flight
    #[arg(long)]
    long: bool,
}

pub(super) fn run(args: &ParamsArgs) -> Result<u8, Failure> {
    let tuning = Tuning::new(&Scenario::new(args.preset, 0).configure())
        .map_err(|why| Failure::failed(why.to_string()))?;
    if args.long {
        for (name, value) in param_file::values(&tuning) {
            let number = parameters::number(name).map(usize::from);
            let parameter = number.and_then(|number| PARAMETERS.get(number));
            data(format_args!(
                "{}",
                parameter.map_or(String::new(), |p| line(p, value))
            ))?;
        }
    } else {
        data(param_file::format(&tuning).trim_end())?;
    }
    Ok(0)
}

/// Formats a line that is still valid in a parameter file.
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
