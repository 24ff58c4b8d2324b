use super::*; use crate::error::*;
impl Scene { 
/// x
pub fn validate(&self)->Result<(),SceneError>{Ok(())} }
/// x
pub fn parse_point(on:&str)->Option<(&str,f64)>{ let (a,b)=on.split_once('@')?; Some((a,b.parse().ok()?)) }
