//! Plans as messages of ROS: `nav_msgs/Path`, one YAML document a path.

use super::PlanError;
use crate::answer::WitnessPath;
use std::fmt::Write as _;

/// The frame of maps.
const FRAME: &str = "map";

/// A pose a step, each a second after the one before, turned to where the path goes next.
pub(super) fn write(paths: &[WitnessPath]) -> Result<String, PlanError> {
    let mut text = String::new();
    for path in paths {
        let Some(points) = path.positions.as_ref().filter(|points| !points.is_empty()) else {
            return Err(PlanError::NoPlace(path.system.clone()));
        };
        if paths.len() > 1 {
            let _ = writeln!(text, "---\n# path {}", path.path);
        }
        let _ = write!(text, "header:\n{}poses:\n", header(0, 2));
        for ((time, point), yaw) in points.iter().enumerate().zip(headings(points)) {
            let (z, w) = (yaw / 2.0).sin_cos();
            let _ = write!(
                text,
                "  - header:\n{}    pose:\n      position: {{x: {:?}, y: {:?}, z: 0.0}}\n      orientation: {{x: 0.0, y: \
                 0.0, z: {:?}, w: {:?}}}\n",
                header(time, 6),
                point.0,
                point.1,
                rounded(z),
                rounded(w),
            );
        }
    }
    Ok(text)
}

fn header(seconds: usize, indent: usize) -> String {
    let blanks = " ".repeat(indent);
    format!("{blanks}stamp: {{sec: {seconds}, nanosec: 0}}\n{blanks}frame_id: {FRAME}\n")
}

fn rounded(value: f64) -> f64 {
    // Without `+ 0.0` there is a negative zero.
    (value * 1e9).round() / 1e9 + 0.0
}

/// The direction in which each point is left, or was reached where the path rests; 0 before it has moved at all.
fn headings(points: &[(f64, f64)]) -> Vec<f64> {
    let mut headings: Vec<f64> = Vec::with_capacity(points.len());
    for (at, &(x, y)) in points.iter().enumerate() {
        let before = headings.last().copied().unwrap_or(0.0);
        let next = points.get(at + 1).filter(|next| **next != (x, y));
        headings.push(next.map_or(before, |next| (next.1 - y).atan2(next.0 - x)));
    }
    headings
}

#[cfg(test)]
mod tests {
    use super::headings;

    #[test]
    fn poses_look_where_they_go() {
        use std::f64::consts::FRAC_PI_2;
        let points = [(0.0, 0.0), (0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 1.0)];
        assert_eq!(headings(&points), [0.0, FRAC_PI_2, 0.0, 0.0, 0.0]);
    }
}
