//! Plans as GeoJSON: a feature for each path, with its actions and states as properties.

use super::{PlanError, points};
use crate::answer::{StrategyFile, WitnessPath};
use serde::{Deserialize, Serialize};

#[derive(Serialize, Deserialize)]
struct Collection {
    r#type: Kind,
    features: Vec<Feature>,
}

#[derive(Serialize, Deserialize)]
enum Kind {
    FeatureCollection,
}

#[derive(Serialize, Deserialize)]
struct Feature {
    #[serde(default)]
    r#type: String,
    /// Of no meaning where it is read: states say where a path is.
    #[serde(default, skip_deserializing)]
    geometry: Option<Geometry>,
    properties: Properties,
}

#[derive(Serialize)]
#[serde(tag = "type", content = "coordinates")]
enum Geometry {
    Point((f64, f64)),
    LineString(Vec<(f64, f64)>),
}

#[derive(Serialize, Deserialize)]
struct Properties {
    #[serde(default)]
    objective: Option<String>,
    #[serde(flatten)]
    path: WitnessPath,
}

pub(super) fn write(objective: &str, paths: &[WitnessPath]) -> Result<String, PlanError> {
    let feature = |path: &WitnessPath| Feature {
        r#type: "Feature".to_owned(),
        geometry: points(path).and_then(|points| match points.as_slice() {
            [] => None,
            [only] => Some(Geometry::Point(*only)),
            _ => Some(Geometry::LineString(points)),
        }),
        properties: Properties {
            objective: Some(objective.to_owned()),
            path: WitnessPath { positions: None, ..path.clone() },
        },
    };
    let all = Collection { r#type: Kind::FeatureCollection, features: paths.iter().map(feature).collect() };
    serde_json::to_string(&all).map(|text| text + "\n").map_err(|e| PlanError::Failed(e.to_string()))
}

/// The strategy of a collection; `None` where the text is no such thing.
pub(super) fn read(text: &str) -> Option<Result<StrategyFile, String>> {
    #[derive(Deserialize)]
    struct Tagged {
        #[serde(rename = "type")]
        _type: Kind,
    }
    serde_json::from_str::<Tagged>(text).ok()?;
    Some(match serde_json::from_str::<Collection>(text) {
        Err(error) => Err(error.to_string()),
        Ok(all) => {
            let objective = all.features.first().and_then(|feature| feature.properties.objective.clone());
            let witness = all.features.into_iter().map(|feature| feature.properties.path).collect();
            Ok(StrategyFile { objective, verdict: None, witness: Some(witness) })
        }
    })
}
