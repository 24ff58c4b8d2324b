//! x
use cosserat::*;
fn main(){ 
 let t=std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
 let s: scene::Scene = toml::from_str(&t).unwrap();
 let t0=std::time::Instant::now();
 let m = model::Model::new(&s).unwrap();
 let t1=std::time::Instant::now();
 let r = statics::solve(&m, s.statics.as_ref().unwrap(), &mut |_,_|());
 let dt=t1.elapsed().as_secs_f64();
 let sol = match r { Ok(s)=>s, Err(e)=>{println!("{e}"); e.partial} };
 println!("setup {:.3} solve {dt:.3} {:?} {}",(t1-t0).as_secs_f64(), sol.statistics, sol.unknowns);
 let f=&sol.rows[0]; let l=sol.rows.last().unwrap();
 for i in 0..f.probes.len(){ let u:Vec<f64>=(0..3).map(|k| l.probes[i].position[k]-f.probes[i].position[k]).collect(); println!("{} u = {:?}", l.parameter,u); }
}
