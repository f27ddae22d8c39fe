BEGIN TRANSACTION;
CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
);
INSERT INTO "alembic_version" VALUES('0003');
CREATE TABLE "recordings" (
	id VARCHAR(32) NOT NULL, 
	bench_id VARCHAR(32) NOT NULL, 
	name VARCHAR(200) NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	title VARCHAR(400) NOT NULL, 
	dt_ms FLOAT NOT NULL, 
	start_tick BIGINT NOT NULL, 
	ticks BIGINT NOT NULL, 
	signals JSON NOT NULL, 
	created DATETIME NOT NULL, 
	finished DATETIME, 
	reason VARCHAR(400) NOT NULL, 
	scenario JSON, 
	events JSON, 
	layout JSON, 
	seed BIGINT, 
	version VARCHAR(64) DEFAULT '' NOT NULL, 
	condition VARCHAR(200) DEFAULT '' NOT NULL, 
	bytes BIGINT DEFAULT '0' NOT NULL, 
	CONSTRAINT pk_recordings PRIMARY KEY (id)
);
INSERT INTO "recordings" VALUES('1f5eaeb37d2e7da52ef20d22d8142a04','409c3763de57','kept','done','Kept',0.01,10,181,'[{"name": "plant.displacement", "unit": "um"}, {"name": "sensor.displacement", "unit": "um"}, {"name": "drive.voltage", "unit": "V"}]','2026-11-22 15:16:03.636102','2026-11-22 15:16:03.813270','stopped','{"schema": 1, "id": "kept-live", "title": "Kept, as run live", "source": "", "sample_rate_khz": 100, "seed": 3, "device": {"id": "ch3"}, "plant": {"model": "linear", "drive_noise_v": 0.01}, "reference": {"kind": "sine", "amplitude_v": 8.0, "frequency_hz": 2000.0}, "controller": {"kind": "open_loop"}, "sensor": {"kind": "ideal"}, "drive": {"quantum_v": 0.005}, "diagnosers": {"kalman": {"kind": "mmae", "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}]}}, "sensors": {"ideal": {"noise_um": 0.02, "quantum_um": 0.001}}, "samples": 20, "events": [{"fault": "stiffness", "severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4, "period_ms": 2.0, "duty": 0.5}, "at_sample": 20}, {"at_sample": 40, "fault": "added_mass", "severity": 0.05}, {"at_sample": 40, "switch": "pid"}, {"at_sample": 45, "heal": ["damping"]}, {"when": "plant.velocity > 5", "set": {"reference.amplitude_v": 4.0, "sensors.ideal.noise_um": 0.05}, "at_sample": 0}]}','[{"seq": 10, "tick": 20, "actor": "api 127.0.0.1", "kind": "inject", "text": "inject stiffness +0.2, ramp", "command": {"kind": "inject", "fault": "stiffness", "severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4, "period_ms": 2.0, "duty": 0.5}, "parameters": {}}, "old": null, "new": {"severity": 0.2, "profile": {"kind": "ramp", "duration_ms": 0.4, "period_ms": 2.0, "duty": 0.5}, "start_tick": 20}, "at": "2026-11-22T15:16:03.591897Z"}, {"seq": 14, "tick": 40, "actor": "scenario", "kind": "inject", "text": "inject added_mass +0.05", "command": {"kind": "inject", "fault": "added_mass", "severity": 0.05, "profile": {"kind": "step", "duration_ms": 5.0, "period_ms": 2.0, "duty": 0.5}, "parameters": {}}, "old": null, "new": {"severity": 0.05, "profile": {"kind": "step", "duration_ms": 5.0, "period_ms": 2.0, "duty": 0.5}, "start_tick": 40}, "at": "2026-11-22T15:16:03.667134Z"}]','{"panels": []}',3,'0.1.0 80499274b1b9d5ea','',121474);
CREATE TABLE results (
	"key" VARCHAR(64) NOT NULL, 
	outcome JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_results PRIMARY KEY ("key")
);
INSERT INTO "results" VALUES('25370cc08d3d472b340fae16bd2990176b3b2fab4559391cf210ee3ce7a900db','{"seed":1,"digest":"0c24e4eeaac3b0fbdb8faab5a16fd76cf8a4a0d21802ddc966f994cd668ba75e","ticks":100,"elapsed_s":0.12942460599879269,"ok":false,"stopped":null,"error":"","warnings":[],"metrics":{"device.mass_kg":2.209e-10,"device.stiffness_n_m":0.0538,"device.damping_ns_m":7.09e-7,"device.thermal_rms_nm":0.277466867307669,"device.f0_hz":2483.781634653885,"device.quality_factor":4.862311303706266,"device.damping_ratio":0.10283175402999765,"device.f_peak_hz":2457.3768565722785,"device.f_damped_hz":2470.614521112205,"device.peak_db":13.783023649099563,"device.half_power_low_hz":2185.555693703831,"device.half_power_high_hz":2701.989700230716,"device.decay_ms":0.6231311706629055,"device.force_n_per_v":6.375e-9,"device.static_gain_um_per_v":-0.11849442379182155,"environment.stiffness_scale":1.0,"environment.damping_scale":1.0,"device.pull_in_v":46.6682326265569,"control.rms_error_um":0.0009465626174765265,"control.tail_rms_error_um":0.0009732058483281189,"control.peak_error_um":0.002364371709064894,"control.settling_ms":0.0,"control.effort_rms_v":7.0710678118654755,"control.first_peak_pct":0.006085927020849091,"control.effort_ratio":1.0,"control.displacement_ratio":0.9997997823374526,"control.amplitude_um":3.0051949733435603,"control.phase_deg":150.52853628939135,"sensing.direction_lost_fraction":0.0,"sensing.rms_error_nm":45.436670029058014,"diagnosis.kalman.correct_fraction":0.9,"diagnosis.kalman.false_switches":0.0,"diagnosis.kalman.missed_steps":0.0,"diagnosis.kalman.delay_samples.1":19.0,"diagnosis.kalman.nis":0.758294418964623},"diagnosis":{"kalman":{"names":["healthy","m+5","m+10","k+5","k+10","b+30"],"confusion":[[90,0,0,3,2,5],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0]],"delays":[],"healthy":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,42,19,5,1,3,1,0,4,0,0,2,0,1,1,0,2,0,0,0,0,0,0,0,0,3,1,0,2,0,1,7,4,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"faulty":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}},"trip":""}','2026-11-26 13:09:55.272238');
CREATE TABLE runs (
	id VARCHAR(32) NOT NULL, 
	"key" VARCHAR(64) NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	scenario_id VARCHAR(200) NOT NULL, 
	title VARCHAR(400) NOT NULL, 
	document JSON NOT NULL, 
	seeds JSON NOT NULL, 
	created DATETIME NOT NULL, 
	finished DATETIME, 
	progress FLOAT NOT NULL, 
	summary JSON, 
	error JSON, attempts INTEGER DEFAULT '0' NOT NULL, 
	CONSTRAINT pk_runs PRIMARY KEY (id)
);
INSERT INTO "runs" VALUES('6d7860394a762919b7887cbbacb341d9','6d7860394a762919b7887cbbacb341d9052846bd4cf8a0238bc74a12f96313d3','done','kept-live','Kept, as run live','{"schema": 1, "id": "kept-live", "title": "Kept, as run live", "source": "", "sample_rate_khz": 100, "seed": 3, "samples": 191, "device": {"id": "ch3"}, "plant": {"model": "linear", "drive_noise_v": 0.01}, "reference": {"kind": "sine", "amplitude_v": 8.0, "frequency_hz": 2000.0}, "controller": {"kind": "open_loop"}, "sensor": {"kind": "ideal"}, "drive": {"quantum_v": 0.005}, "diagnosers": {"kalman": {"kind": "mmae", "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}]}}, "sensors": {"ideal": {"noise_um": 0.02, "quantum_um": 0.001}}, "events": [{"fault": "stiffness", "severity": 0.2, "at_sample": 20, "profile": {"kind": "ramp", "duration_ms": 0.4, "period_ms": 2.0, "duty": 0.5}}, {"at_sample": 25, "set": {"reference.amplitude_v": 4.0, "sensors.ideal.noise_um": 0.05}}, {"fault": "added_mass", "severity": 0.05, "at_sample": 40}, {"switch": "pid", "at_sample": 40}, {"fault": "point_adhesion", "severity": 1.0, "at_sample": 80, "parameters": {"beam": "outer", "position": 0.5}}, {"switch": "mrac", "cold": true, "at_sample": 80}, {"at_sample": 80, "set": {"reference.amplitude_v": 6.0}}, {"heal": ["added_mass"], "at_sample": 80}, {"fault": "damping", "severity": 0.5, "at_sample": 120, "profile": {"kind": "intermittent", "duration_ms": 5.0, "period_ms": 0.2, "duty": 0.3}}, {"switch": "open_loop", "at_sample": 130}, {"at_sample": 140, "set": {"guard.travel_um": 1e-06}}, {"at_sample": 141, "set": {"guard.travel_um": 25.0}}, {"reset_trip": true, "at_sample": 141}, {"heal": "all", "at_sample": 181}, {"when": "plant.displacement > 1000", "heal": "all", "at_sample": 80}]}','[3]','2026-11-22 15:16:04.133677','2026-11-22 15:16:11.052125',1.0,'{"scenario": "kept-live", "title": "Kept, as run live", "source": "", "claim": "", "verdict": null, "seed": 3, "ticks": 191, "dt_s": 1e-05, "elapsed_s": 0.038532248999956664, "digest": "2f0f2d4d9a173b42faca46ba454b218daa9406f185052e15fee0c2305e3f7e9a", "trip": null, "warnings": [], "metrics": {"device.mass_kg": 2.209e-10, "device.stiffness_n_m": 0.0538, "device.damping_ns_m": 7.09e-07, "device.force_n_per_v": 1.619051485769143e-08, "device.static_gain_um_per_v": -0.3009389378753054, "device.thermal_rms_nm": 0.277466867307669, "device.f0_hz": 2483.781634653885, "device.quality_factor": 4.862311303706266, "device.damping_ratio": 0.10283175402999765, "device.f_peak_hz": 2457.3768565722785, "device.f_damped_hz": 2470.614521112205, "device.peak_db": 13.783023649099563, "device.half_power_low_hz": 2185.555693703831, "device.half_power_high_hz": 2701.989700230716, "device.decay_ms": 0.6231311706629055, "environment.stiffness_scale": 1.0, "environment.damping_scale": 1.0, "device.pull_in_v": 53.46511329607781, "control.rms_error_um": 1.7700852751916616, "control.tail_rms_error_um": 1.7607513127235304, "control.peak_error_um": 4.694741470367814, "control.settling_ms": 1.9100000000000001, "control.effort_rms_v": 4.195419811631886, "control.first_peak_pct": -0.010042494468087693, "control.effort_ratio": 1.0000070196077868, "control.displacement_ratio": 0.2545197666813872, "control.amplitude_um": 0.5903230693122152, "control.phase_deg": 172.91543166302586, "sensing.direction_lost_fraction": 0.0, "sensing.rms_error_nm": 49.5381205397216, "diagnosis.kalman.correct_fraction": 0.1099476439790576, "diagnosis.kalman.false_switches": 0.0, "diagnosis.kalman.missed_steps": 2.0, "diagnosis.kalman.mean_delay_samples": 10.0, "diagnosis.kalman.delay_samples.1": 21.0, "diagnosis.kalman.delay_samples.2": 10.0, "diagnosis.kalman.nis": 5.083380345855995}, "expectations": [], "ok": true}','null',1);
CREATE TABLE sweeps (
	id VARCHAR(32) NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	name VARCHAR(64) NOT NULL, 
	title VARCHAR(200) NOT NULL, 
	document JSON NOT NULL, 
	version VARCHAR(16) NOT NULL, 
	runs INTEGER NOT NULL, 
	created DATETIME NOT NULL, 
	finished DATETIME, 
	error JSON, done INTEGER DEFAULT '0' NOT NULL, 
	CONSTRAINT pk_sweeps PRIMARY KEY (id)
);
INSERT INTO "sweeps" VALUES('0b3938128aa26372100c2938e6114fc5','done','small','','{"schema": 1, "id": "small", "scenario": "ch5-seven-step", "set": {"samples": 100}, "seeds": {"count": 3}}','d8a93396fd67756a',3,'2026-11-26 13:09:35.823283','2026-11-26 13:09:55.372376','null',3);
CREATE INDEX ix_runs_created ON runs (created);
CREATE INDEX ix_runs_key ON runs ("key");
CREATE INDEX ix_runs_state ON runs (state);
CREATE INDEX ix_sweeps_created ON sweeps (created);
CREATE INDEX ix_sweeps_state ON sweeps (state);
CREATE INDEX ix_results_created ON results (created);
CREATE INDEX ix_recordings_created ON recordings (created);
CREATE INDEX ix_recordings_state ON recordings (state);
CREATE INDEX ix_recordings_bench_id ON recordings (bench_id);
COMMIT;
