//! Fields of obstacles.

use crate::errors::{input, scenario};
use crate::input::{argument, finite, rows, text, vector};
use crate::output::plain;
use crate::typed::typed;
use mpp_sim::field::{Circle, Field as _, FieldFile, Line, ObstacleField, Polygon, Shape};
use mpp_sim::scenario::ScenarioFile;
use numpy::{PyArray1, PyArray2};
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// The obstacles of a flight, where they are at its start. Give a file as docs/fields.md describes, or a dict with
/// its keys.
#[pyclass(frozen, module = "mppflight")]
pub(crate) struct Field {
    pub(crate) file: FieldFile,
    pub(crate) field: ObstacleField,
}

impl Field {
    /// A field that keeps to the rules of field files.
    pub(crate) fn checked(file: FieldFile) -> PyResult<Self> {
        file.check().map_err(input)?;
        let field = ObstacleField::new(file.obstacles());
        Ok(Self { file, field })
    }
}

#[pymethods]
impl Field {
    #[new]
    fn new(source: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(keys) = source.cast::<PyDict>() {
            return Self::checked(typed("field", keys)?);
        }
        let (path, text) = text("field", source)?;
        let file = FieldFile::parse(&path, &text).map_err(input)?;
        Self::checked(file)
    }

    /// The field that a generator draws for a flight with this seed and this number of obstacles over 215 m, for
    /// example `Field.generate("forest", obstacles=60, seed=7, radius=1.5)`. The parameters are those that the
    /// generator takes. The flight lasts for `duration` [s]; lengths are `world_scale` times as long.
    #[staticmethod]
    #[pyo3(signature = (
        generator = None, *, obstacles = 20, seed = 1, duration = None, world_scale = 1.0, **parameters
    ), text_signature = "(generator=\"paper\", *, obstacles=20, seed=1, duration=None, world_scale=1.0, \
        **parameters)")]
    fn generate(
        py: Python<'_>,
        generator: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = argument)] obstacles: usize,
        #[pyo3(from_py_with = argument)] seed: u64,
        #[pyo3(from_py_with = argument)] duration: Option<f64>,
        #[pyo3(from_py_with = argument)] world_scale: f64,
        parameters: Option<&Bound<'_, PyDict>>,
    ) -> PyResult<Self> {
        let keys = parameters.map_or_else(|| Ok(PyDict::new(py)), Bound::copy)?;
        keys.set_item("name", generator)?;
        let file = ScenarioFile {
            generator: typed("generator", &keys)?,
            obstacles: Some(obstacles),
            seed: Some(seed),
            duration,
            world_scale: Some(world_scale),
            ..ScenarioFile::default()
        };
        let scenario = py.detach(|| file.build()).map_err(scenario)?;
        Self::checked(FieldFile::of(&scenario.field().obstacles))
    }

    /// A field of arrays [m]: circles as rows of x, z, radius; polygons as arrays of corners x, z, whose last may repeat the first; ground and
    /// ceiling as lines of points x, z.
    #[staticmethod]
    #[pyo3(signature = (circles = None, polygons = None, ground = None, ceiling = None))]
    fn of_arrays(
        circles: Option<&Bound<'_, PyAny>>,
        polygons: Option<&Bound<'_, PyAny>>,
        ground: Option<&Bound<'_, PyAny>>,
        ceiling: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let points = |name: &str, array: &Bound<'_, PyAny>| {
            let rows = rows::<2>(name, array)?;
            PyResult::Ok(rows.into_iter().map(|[x, z]| (x, z)).collect::<Vec<_>>())
        };
        let line = |name: &str, array: Option<&Bound<'_, PyAny>>| {
            let points = array.map(|array| points(name, array)).transpose()?;
            PyResult::Ok(points.map(|points| Line { points }).into_iter().collect())
        };
        let circles = circles
            .map(|array| rows::<3>("circles", array))
            .transpose()?;
        let circle = |[x, z, radius]: [f64; 3]| Circle {
            x,
            z,
            radius,
            velocity: (0.0, 0.0),
        };
        let rings = polygons.map(|all| all.try_iter()?.collect::<PyResult<Vec<_>>>());
        let rings = rings.transpose();
        let rings = rings.map_err(|_| input("polygons: give a list of arrays of corners"))?;
        let polygon = |array: Bound<'_, PyAny>| points("polygons", &array).map(Polygon::of_ring);
        Self::checked(FieldFile {
            circle: circles
                .unwrap_or_default()
                .into_iter()
                .map(circle)
                .collect(),
            polygon: (rings.unwrap_or_default().into_iter())
                .map(polygon)
                .collect::<PyResult<_>>()?,
            ground: line("ground", ground)?,
            ceiling: line("ceiling", ceiling)?,
            ..FieldFile::default()
        })
    }

    /// A dict with the keys of a field file.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        plain(py, &self.file)
    }

    /// Its circles as rows of x, z, radius [m].
    #[getter]
    fn circles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = self
            .field
            .obstacles
            .iter()
            .filter_map(|one| match one.shape {
                Shape::Circle {
                    centre: (x, z),
                    radius,
                } => Some(vec![x, z, radius]),
                _ => None,
            });
        let rows: Vec<Vec<f64>> = rows.collect();
        if rows.is_empty() {
            return Ok(PyArray2::zeros(py, [0, 3], false));
        }
        PyArray2::from_vec2(py, &rows).map_err(input)
    }

    /// Distances from points, rows of x, z, to the nearest edge at a time [s]; negative inside [m].
    #[pyo3(signature = (points, time = 0.0))]
    fn clearance<'py>(
        &self,
        points: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = argument)] time: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let (py, time) = (points.py(), finite("time", time)?);
        let points = rows::<2>("points", points)?;
        for value in points.iter().flatten() {
            finite("points", *value)?;
        }
        let clearance = |[x, z]: [f64; 2]| {
            let apart = self
                .field
                .obstacles
                .iter()
                .map(|one| one.clearance((x, z), time));
            apart.fold(f64::INFINITY, f64::min)
        };
        Ok(PyArray1::from_vec(
            py,
            points.into_iter().map(clearance).collect(),
        ))
    }

    /// Distances along rays from a place at angles above the horizon [rad] to the first obstacle [m]; infinite
    /// where there is none.
    #[pyo3(signature = (x, z, angles, time = 0.0))]
    fn ranges<'py>(
        &self,
        #[pyo3(from_py_with = argument)] x: f64,
        #[pyo3(from_py_with = argument)] z: f64,
        angles: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = argument)] time: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut field = self.field.clone();
        field.move_to(finite("time", time)?);
        let from = (finite("x", x)?, finite("z", z)?);
        let range = |angle: f64| {
            let (up, ahead) = libm::sincos(angle);
            field.range(from, (ahead, up)).unwrap_or(f64::INFINITY)
        };
        let ranges = (vector("angles", angles)?.into_iter())
            .map(|angle| finite("angles", angle).map(range))
            .collect::<PyResult<_>>()?;
        Ok(PyArray1::from_vec(angles.py(), ranges))
    }

    /// The text of a field file.
    fn to_toml(&self) -> PyResult<String> {
        self.file.to_toml().map_err(input)
    }

    fn __len__(&self) -> usize {
        self.field.obstacles.len()
    }

    fn __repr__(&self) -> String {
        format!("Field({} obstacles)", self.__len__())
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyAny>,))> {
        Ok((slf.get_type().into_any(), (slf.get().table(slf.py())?,)))
    }
}
