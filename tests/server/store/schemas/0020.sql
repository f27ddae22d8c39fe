BEGIN TRANSACTION;
CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
);
INSERT INTO "alembic_version" VALUES('0020');
CREATE TABLE audit (
	id INTEGER NOT NULL, 
	at DATETIME NOT NULL, 
	actor VARCHAR(120) NOT NULL, 
	class_id VARCHAR(32), 
	bench_id VARCHAR(32), 
	tick BIGINT, 
	kind VARCHAR(32) NOT NULL, 
	text VARCHAR(400) NOT NULL, 
	CONSTRAINT pk_audit PRIMARY KEY (id)
);
INSERT INTO "audit" VALUES(1,'2026-11-26 13:09:55.628210','teacher','f7hk',NULL,NULL,'class','opened the class Tuesday');
INSERT INTO "audit" VALUES(2,'2026-11-26 13:09:56.742205','Ada','f7hk',NULL,NULL,'joined','joined the class');
INSERT INTO "audit" VALUES(3,'2026-11-26 13:09:56.926859','teacher','f7hk',NULL,NULL,'blind','hid a fault on 1 benches');
INSERT INTO "audit" VALUES(4,'2026-11-26 13:09:57.022601','Ada','f7hk','f4a1db1ea6f2',0,'revealed','the hidden fault was shown');
INSERT INTO "audit" VALUES(5,'2026-11-26 13:09:58.288484','Ada','f7hk',NULL,NULL,'game','be-the-filter, seed 7: 14.9 points');
CREATE TABLE ballots (
	vote_id VARCHAR(32) NOT NULL, 
	person_id VARCHAR(32) NOT NULL, 
	answer INTEGER NOT NULL, 
	at_ms DOUBLE, 
	CONSTRAINT pk_ballots PRIMARY KEY (vote_id, person_id)
);
INSERT INTO "ballots" VALUES('60248158355dcf8c','81299b607ecda7b1',1,NULL);
CREATE TABLE blind_answers (
	id VARCHAR(32) NOT NULL, 
	class_id VARCHAR(32), 
	person_id VARCHAR(32) NOT NULL, 
	began DATETIME NOT NULL, 
	answer JSON NOT NULL, 
	CONSTRAINT pk_blind_answers PRIMARY KEY (id)
);
INSERT INTO "blind_answers" VALUES('dd1391640e202989','f7hk','81299b607ecda7b1','2026-11-26 13:09:56.876254','{"id": "dd1391640e202989", "exercise": "e90d35aeb11c", "class_id": "f7hk", "person_id": "81299b607ecda7b1", "name": "Ada", "bench": "f4a1db1ea6f2", "title": "Seven-step fault scenario, Kalman bank", "seed": null, "state": "answered", "said": "healthy", "confidence": 0.5, "points": -32.00000000000001, "truth": "b+30", "factors": {"healthy": {}, "m+5": {"mass": 1.05}, "m+10": {"mass": 1.1}, "k+5": {"stiffness": 1.05}, "k+10": {"stiffness": 1.1}, "b+30": {"damping": 1.3}}, "came_tick": 298, "ended_tick": 0, "took_ms": null, "verdicts": {"kalman": "healthy"}, "healthy": {"f0_hz": 2346.46211961724, "quality_factor": 4.423115820803956, "rest_um_per_v": 0.1362439515975563, "peak_um_per_v": 0.6065104153494889}, "faulty": {"f0_hz": 2346.46211961724, "quality_factor": 3.402396785233812, "rest_um_per_v": 0.1362439515975563, "peak_um_per_v": 0.46864398286728776}, "began": "2026-11-26T13:09:56.876254Z", "ended": "2026-11-26T13:09:57.001164Z"}');
CREATE TABLE classes (
	id VARCHAR(32) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	code_hash VARCHAR(64), 
	code_until DATETIME, 
	scenario JSON NOT NULL, 
	created DATETIME NOT NULL, 
	until DATETIME NOT NULL, secret VARCHAR(64) DEFAULT '' NOT NULL, shown VARCHAR(32), layout JSON, sheet VARCHAR(40), 
	CONSTRAINT pk_classes PRIMARY KEY (id)
);
INSERT INTO "classes" VALUES('f7hk','Tuesday',NULL,NULL,'{"source": "ch5-seven-step", "values": {}, "seed": null, "paused": false, "time_scale": 0.002, "own_scale": true, "quiet_lead": false}','2026-11-26 13:09:55.600576','2099-01-01 00:00:00.000000','0pWHhGx8v9CE8yCYuwdttr2-EZqhavQBEuvgagDKn18',NULL,NULL,NULL);
CREATE TABLE game_attempts (
	id VARCHAR(32) NOT NULL, 
	class_id VARCHAR(32), 
	person_id VARCHAR(32) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	game VARCHAR(40) NOT NULL, 
	seed BIGINT NOT NULL, 
	points FLOAT, 
	at DATETIME NOT NULL, 
	attempt JSON NOT NULL, 
	CONSTRAINT pk_game_attempts PRIMARY KEY (id)
);
INSERT INTO "game_attempts" VALUES('1eb6c9ea0d07c0ac','f7hk','81299b607ecda7b1','Ada','be-the-filter',7,1.48971998126305358312e+01,'2026-11-26 13:09:58.260533','{"handed_in": {"assumed_noise_scale": 1.0, "process_noise_v": 0.3, "probability_floor": 0.001, "mass": 1.0, "stiffness": 1.0, "damping": 1.0}, "outcome": {"points": 14.897199812630536, "figures": {"brier": 0.7091900015614122, "brier_given": 0.25799420967278236, "brier_unknown": 1.9499784292551563, "credit": 0.0, "default_points": 14.897199812630536}, "said": "14.9 points; the default settings earn 14.9. While one of the five was true you earned 69.0, during the unknown fault \u2212134.0, without a sixth.", "worked": "P=100\\left(1-\\frac{0.7092}{0.8333}\\right)=14.9,\\quad w=0.00"}}');
CREATE TABLE links (
	id VARCHAR(32) NOT NULL, 
	kind VARCHAR(16) NOT NULL, 
	title VARCHAR(200) NOT NULL, 
	note VARCHAR(2000) NOT NULL, 
	scenario_id VARCHAR(200), 
	tick BIGINT, 
	digest VARCHAR(64), 
	version VARCHAR(64) NOT NULL, 
	content JSON NOT NULL, 
	bytes BIGINT NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_links PRIMARY KEY (id)
);
INSERT INTO "links" VALUES('zta32b29','layout','two scopes','',NULL,NULL,NULL,'0.1.0 d8a93396fd67756a','{"experiment": null, "layout": {"panels": []}}',46,'2026-11-26 13:09:35.811772');
CREATE TABLE lti_keys (
	"key" VARCHAR(64) NOT NULL, 
	class_id VARCHAR(32) NOT NULL, 
	person_id VARCHAR(32), 
	CONSTRAINT pk_lti_keys PRIMARY KEY ("key")
);
INSERT INTO "lti_keys" VALUES('5555555555555555555555555555555555555555555555555555555555555555','f7hk','81299b607ecda7b1');
CREATE TABLE measured_devices (
	id VARCHAR(32) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	record_key VARCHAR(64) NOT NULL, 
	"values" JSON NOT NULL, 
	calibration JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_measured_devices PRIMARY KEY (id), 
	CONSTRAINT uq_measured_devices_name UNIQUE (name)
);
INSERT INTO "measured_devices" VALUES('dev0aabbccdd','device of Tuesday','5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a','{"device.mass_kg": 2.3e-10}','{"refusal": ""}','2026-11-20 10:05:00.000000');
CREATE TABLE parameter_sets (
	id VARCHAR(32) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	scenario VARCHAR(200) NOT NULL, 
	"values" JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_parameter_sets PRIMARY KEY (id), 
	CONSTRAINT uq_parameter_sets_name UNIQUE (name)
);
INSERT INTO "parameter_sets" VALUES('b10da72226beb2fb','stiff','ch5-seven-step','{"reference.kind": "sine", "reference.amplitude_v": 10.0, "reference.amplitude_um": null, "reference.offset_v": 0.0, "reference.frequency_hz": 2000.0, "reference.phase_deg": 0.0}','2026-11-26 13:09:35.676737');
CREATE TABLE people (
	id VARCHAR(32) NOT NULL, 
	role VARCHAR(16) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	class_id VARCHAR(32), 
	bench_id VARCHAR(32), 
	secret_hash VARCHAR(64) NOT NULL, 
	joined DATETIME NOT NULL, 
	until DATETIME NOT NULL, earlier JSON, lent VARCHAR(32), 
	CONSTRAINT pk_people PRIMARY KEY (id), 
	CONSTRAINT uq_people_secret_hash UNIQUE (secret_hash)
);
INSERT INTO "people" VALUES('81299b607ecda7b1','student','Ada','f7hk','f4a1db1ea6f2','c929bcdde1a19f444a19070a403cf0bfd4298d4e75d0d2d53dafd36a9438159e','2026-11-26 13:09:55.634200','2099-01-01 00:00:00.000000','["e488655ba2ca", "bc973d0d16c1"]',NULL);
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
CREATE TABLE records (
	id VARCHAR(32) NOT NULL, 
	"key" VARCHAR(64) NOT NULL, 
	name VARCHAR(200) NOT NULL, 
	owner VARCHAR(32) NOT NULL, 
	rate_khz FLOAT NOT NULL, 
	samples BIGINT NOT NULL, 
	bytes BIGINT NOT NULL, 
	about JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_records PRIMARY KEY (id)
);
INSERT INTO "records" VALUES('rec0aabbccdd','5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a5a','device.csv','',50.0,2000,32000,'{"columns": {"drive": "drive", "displacement": "displacement", "time": "time_ms"}, "notes": [], "labels": [], "lost": 0, "drive_v": [-10.0, 10.0], "displacement_um": [-2.0, 2.0]}','2026-11-20 10:00:00.000000');
CREATE TABLE "requests" (
	id VARCHAR(32) NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	label VARCHAR(120) DEFAULT ('') NOT NULL, 
	document JSON NOT NULL, 
	created DATETIME NOT NULL, 
	finished DATETIME, 
	error JSON, 
	kind VARCHAR(16) NOT NULL, 
	"key" VARCHAR(64) DEFAULT ('') NOT NULL, 
	name VARCHAR(200) NOT NULL, 
	scenario_id VARCHAR(200) NOT NULL, 
	title VARCHAR(400) NOT NULL, 
	seeds JSON, 
	version VARCHAR(16) DEFAULT ('') NOT NULL, 
	runs INTEGER NOT NULL, 
	done INTEGER DEFAULT '0' NOT NULL, 
	attempts INTEGER DEFAULT '0' NOT NULL, 
	summary JSON, 
	everything BOOLEAN DEFAULT 0 NOT NULL, 
	CONSTRAINT pk_requests PRIMARY KEY (id)
);
INSERT INTO "requests" VALUES('6d7860394a762919b7887cbbacb341d9','done','','{"schema": 1, "id": "kept-live", "title": "Kept, as run live", "source": "", "sample_rate_khz": 100, "seed": 3, "samples": 191, "device": {"id": "ch3"}, "plant": {"model": "linear", "drive_noise_v": 0.01}, "reference": {"kind": "sine", "amplitude_v": 8.0, "frequency_hz": 2000.0}, "controller": {"kind": "open_loop"}, "sensor": {"kind": "ideal"}, "drive": {"quantum_v": 0.005}, "diagnosers": {"kalman": {"kind": "mmae", "hypotheses": [{"name": "healthy"}, {"name": "m+5", "mass": 1.05}, {"name": "b+30", "damping": 1.3}]}}, "sensors": {"ideal": {"noise_um": 0.02, "quantum_um": 0.001}}, "events": [{"fault": "stiffness", "severity": 0.2, "at_sample": 20, "profile": {"kind": "ramp", "duration_ms": 0.4, "period_ms": 2.0, "duty": 0.5}}, {"at_sample": 25, "set": {"reference.amplitude_v": 4.0, "sensors.ideal.noise_um": 0.05}}, {"fault": "added_mass", "severity": 0.05, "at_sample": 40}, {"switch": "pid", "at_sample": 40}, {"fault": "point_adhesion", "severity": 1.0, "at_sample": 80, "parameters": {"beam": "outer", "position": 0.5}}, {"switch": "mrac", "cold": true, "at_sample": 80}, {"at_sample": 80, "set": {"reference.amplitude_v": 6.0}}, {"heal": ["added_mass"], "at_sample": 80}, {"fault": "damping", "severity": 0.5, "at_sample": 120, "profile": {"kind": "intermittent", "duration_ms": 5.0, "period_ms": 0.2, "duty": 0.3}}, {"switch": "open_loop", "at_sample": 130}, {"at_sample": 140, "set": {"guard.travel_um": 1e-06}}, {"at_sample": 141, "set": {"guard.travel_um": 25.0}}, {"reset_trip": true, "at_sample": 141}, {"heal": "all", "at_sample": 181}, {"when": "plant.displacement > 1000", "heal": "all", "at_sample": 80}]}','2026-11-22 15:16:04.133677','2026-11-22 15:16:11.052125','null','run','6d7860394a762919b7887cbbacb341d9052846bd4cf8a0238bc74a12f96313d3','kept-live','kept-live','Kept, as run live','[3]','',1,1,1,'{"scenario": "kept-live", "title": "Kept, as run live", "source": "", "claim": "", "verdict": null, "seed": 3, "ticks": 191, "dt_s": 1e-05, "elapsed_s": 0.038532248999956664, "digest": "2f0f2d4d9a173b42faca46ba454b218daa9406f185052e15fee0c2305e3f7e9a", "trip": null, "warnings": [], "metrics": {"device.mass_kg": 2.209e-10, "device.stiffness_n_m": 0.0538, "device.damping_ns_m": 7.09e-07, "device.force_n_per_v": 1.619051485769143e-08, "device.static_gain_um_per_v": -0.3009389378753054, "device.thermal_rms_nm": 0.277466867307669, "device.f0_hz": 2483.781634653885, "device.quality_factor": 4.862311303706266, "device.damping_ratio": 0.10283175402999765, "device.f_peak_hz": 2457.3768565722785, "device.f_damped_hz": 2470.614521112205, "device.peak_db": 13.783023649099563, "device.half_power_low_hz": 2185.555693703831, "device.half_power_high_hz": 2701.989700230716, "device.decay_ms": 0.6231311706629055, "environment.stiffness_scale": 1.0, "environment.damping_scale": 1.0, "device.pull_in_v": 53.46511329607781, "control.rms_error_um": 1.7700852751916616, "control.tail_rms_error_um": 1.7607513127235304, "control.peak_error_um": 4.694741470367814, "control.settling_ms": 1.9100000000000001, "control.effort_rms_v": 4.195419811631886, "control.first_peak_pct": -0.010042494468087693, "control.effort_ratio": 1.0000070196077868, "control.displacement_ratio": 0.2545197666813872, "control.amplitude_um": 0.5903230693122152, "control.phase_deg": 172.91543166302586, "sensing.direction_lost_fraction": 0.0, "sensing.rms_error_nm": 49.5381205397216, "diagnosis.kalman.correct_fraction": 0.1099476439790576, "diagnosis.kalman.false_switches": 0.0, "diagnosis.kalman.missed_steps": 2.0, "diagnosis.kalman.mean_delay_samples": 10.0, "diagnosis.kalman.delay_samples.1": 21.0, "diagnosis.kalman.delay_samples.2": 10.0, "diagnosis.kalman.nis": 5.083380345855995}, "expectations": [], "ok": true}',0);
INSERT INTO "requests" VALUES('0b3938128aa26372100c2938e6114fc5','done','three seeds','{"schema": 1, "id": "small", "scenario": "ch5-seven-step", "set": {"samples": 100}, "seeds": {"count": 3}}','2026-11-26 13:09:35.823283','2026-11-26 13:09:55.372376','null','campaign','0b3938128aa26372100c2938e6114fc57a0a109b3392c2a57f337c092b933167','small','ch5-seven-step','','null','d8a93396fd67756a',3,3,0,'null',0);
CREATE TABLE results (
	"key" VARCHAR(64) NOT NULL, 
	outcome JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_results PRIMARY KEY ("key")
);
INSERT INTO "results" VALUES('25370cc08d3d472b340fae16bd2990176b3b2fab4559391cf210ee3ce7a900db','{"seed":1,"digest":"0c24e4eeaac3b0fbdb8faab5a16fd76cf8a4a0d21802ddc966f994cd668ba75e","ticks":100,"elapsed_s":0.12942460599879269,"ok":false,"stopped":null,"error":"","warnings":[],"metrics":{"device.mass_kg":2.209e-10,"device.stiffness_n_m":0.0538,"device.damping_ns_m":7.09e-7,"device.thermal_rms_nm":0.277466867307669,"device.f0_hz":2483.781634653885,"device.quality_factor":4.862311303706266,"device.damping_ratio":0.10283175402999765,"device.f_peak_hz":2457.3768565722785,"device.f_damped_hz":2470.614521112205,"device.peak_db":13.783023649099563,"device.half_power_low_hz":2185.555693703831,"device.half_power_high_hz":2701.989700230716,"device.decay_ms":0.6231311706629055,"device.force_n_per_v":6.375e-9,"device.static_gain_um_per_v":-0.11849442379182155,"environment.stiffness_scale":1.0,"environment.damping_scale":1.0,"device.pull_in_v":46.6682326265569,"control.rms_error_um":0.0009465626174765265,"control.tail_rms_error_um":0.0009732058483281189,"control.peak_error_um":0.002364371709064894,"control.settling_ms":0.0,"control.effort_rms_v":7.0710678118654755,"control.first_peak_pct":0.006085927020849091,"control.effort_ratio":1.0,"control.displacement_ratio":0.9997997823374526,"control.amplitude_um":3.0051949733435603,"control.phase_deg":150.52853628939135,"sensing.direction_lost_fraction":0.0,"sensing.rms_error_nm":45.436670029058014,"diagnosis.kalman.correct_fraction":0.9,"diagnosis.kalman.false_switches":0.0,"diagnosis.kalman.missed_steps":0.0,"diagnosis.kalman.delay_samples.1":19.0,"diagnosis.kalman.nis":0.758294418964623},"diagnosis":{"kalman":{"names":["healthy","m+5","m+10","k+5","k+10","b+30"],"confusion":[[90,0,0,3,2,5],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0],[0,0,0,0,0,0]],"delays":[],"healthy":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,42,19,5,1,3,1,0,4,0,0,2,0,1,1,0,2,0,0,0,0,0,0,0,0,3,1,0,2,0,1,7,4,0,0,0,0,1,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0],"faulty":[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]}},"trip":""}','2026-11-26 13:09:55.272238');
CREATE TABLE sheet_progress (
	person_id VARCHAR(32) NOT NULL, 
	sheet_id VARCHAR(40) NOT NULL, 
	class_id VARCHAR(32), 
	bench_id VARCHAR(32) NOT NULL, 
	begun DATETIME NOT NULL, 
	progress JSON NOT NULL, 
	CONSTRAINT pk_sheet_progress PRIMARY KEY (person_id, sheet_id)
);
INSERT INTO "sheet_progress" VALUES('81299b607ecda7b1','own-5d76f5','f7hk','bc973d0d16c1','2026-11-26 13:09:56.772861','{"facts": {"mass_kg": 2.0994592622280125e-10, "stiffness_n_m": 0.042878943088147395, "damping_ns_m": 7.023793312094741e-07, "thermal_rms_nm": 0.3107994436358772, "f0_hz": 2274.513095531125, "quality_factor": 4.2717324007121995, "damping_ratio": 0.11704853045491288, "f_peak_hz": 2243.135012316871, "f_damped_hz": 2258.8785387028215, "peak_db": 12.671992024041305, "half_power_low_hz": 1956.7573625535413, "half_power_high_hz": 2496.880051395366, "decay_ms": 0.5978135087240716, "force_n_per_v": 6.375e-09, "static_gain_um_per_v": -0.14867437350064205, "pull_in_v": 43.35201746857799, "dt_ms": 0.01, "tone_hz": 1500.0, "r2": 0.4349162501187898, "lag2": 0.023834034144497623, "gain": 1.707087061087263, "amplitude": 2.538000993182011, "heavy": 1.7703964275392277, "growth": 3.7086196653404624}, "steps": {}, "recordings": []}');
CREATE TABLE sheets (
	id VARCHAR(40) NOT NULL, 
	text TEXT NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_sheets PRIMARY KEY (id)
);
INSERT INTO "sheets" VALUES('own-5d76f5','+++
schema = 1
title = "My first look: a resonator and who watches it"
summary = "Read an amplitude, make the plate heavier, predict what happens, and see how soon a bank of filters notices."
minutes = 20

[bench]
scenario = "first-look"
drawn_device = true
set = { "device.id" = "lcr-350", "reference.frequency_hz" = 1500.0 }

[numbers]
r2 = "(tone_hz / f0_hz)**2"
lag2 = "r2 / quality_factor**2"
gain = "1 / sqrt((1 - r2)**2 + lag2)"
amplitude = "10 * abs(static_gain_um_per_v) * gain"
heavy = "1 / sqrt((1 - 1.05 * r2)**2 + lag2)"
growth = "100 * (heavy / gain - 1)"
+++

**Goal.** You get to know the bench: a plate on thin beams, pushed by combs, watched by a sensor and by six filters. Each
student has a device of their own, drawn from the spread of the process. So your numbers differ from the numbers of your
neighbour.

The drive is a sine of 10 V at {{ tone_hz | Hz }}. The plate obeys $m\ddot x+\beta\dot x+kx=F$, with $k=2k_s$ for the
springs of both sides.

## Let it run

Press **Run**. The legend of the scope names its traces: *plant displacement* is the true one, *sensor displacement* the
measured one.

```step
id = "running"
kind = "hold"
points = 1.0
for_ms = 4.0
window_ms = 2.0
trace = ["plant.displacement"]
conditions = [
  { label = "Amplitude of the displacement", signal = "plant.displacement", measure = "amplitude", between = [0.1, 20.0], unit = "um" },
]
hints = [{ text = "Run is the button with the triangle. A step checks itself as soon as time runs.", costs = 0.0 }]
```

Device time runs slowly here, so that you can see each swing. The clock of the page counts it.

## Read the amplitude

Measure the amplitude of the displacement, from the middle to the top. Dragging on the scope stops the picture; cursors A
and B read values.

```step
id = "amplitude"
kind = "question"
points = 2.0
question = "What is the amplitude of the displacement?"
hints = [{ text = "Half of the distance between the highest and the lowest point of the trace.", costs = 0.25 }]
[number]
value = "amplitude"
unit = "um"
within = 0.04
partly = { within = 0.1, share = 0.5 }
mistakes = [{ value = "2 * amplitude", share = 0.5, because = "that is from peak to peak; the amplitude is half of it" }]
```

Yours is {{ amplitude | um }}: $|x|=\frac{|F|/k}{\sqrt{(1-r^2)^2+(r/Q)^2}}$ with $r=f/f_0$, $f_0=$ {{ f0_hz | Hz }} and
$Q=$ {{ quality_factor }}.

## Predict: a heavier plate

In a moment you put 5 % more mass on the plate. The drive, {{ tone_hz | Hz }}, is below the resonance. Think before you look.

```step
id = "guess"
kind = "prediction"
points = 2.0
until = "heavy"
question = "What does the amplitude do when the plate gets 5 % heavier?"
[choice]
options = [
  { id = "grows", text = "It grows", share = 1.0, because = "the resonance moves down, towards the drive" },
  { id = "shrinks", text = "It shrinks", because = "a heavier plate is harder to move, but here the drive comes nearer to the resonance, and that counts more" },
  { id = "stays", text = "It stays as it is", because = "that is so far below the resonance only" },
]
```

## Run: 5 % more mass

Inject *Added mass*, 5 %, in the panel **Faults**. Then watch the lanes of the Kalman bank until it says *mass +5 %*. The step
is done when it has said so for 3 ms.

```step
id = "heavy"
kind = "hold"
points = 2.0
for_ms = 3.0
trace = ["plant.displacement", "sensor.displacement"]
conditions = [
  { label = "Added mass", fault = "added_mass", between = [0.049, 0.051] },
  { label = "The Kalman bank says", verdict = "kalman", equals = "m+5" },
]
```

Six filters run side by side. Each assumes another device: healthy, heavier, stiffer, more damped. The filter with the true
assumption predicts best, and its probability grows.

## How much did it grow?

Compare the amplitude now with the amplitude before.

```step
id = "growth"
kind = "question"
points = 2.0
question = "By how many percent is the amplitude larger than before?"
hints = [{ text = "Put 1.05 m into the formula above: r squared grows by 5 %, Q grows with the root of the mass.", costs = 0.5 }]
[number]
value = "growth"
unit = "%"
within = 0.05
within_absolute = 1.0
wrong_sign = 0.25
right_sign = 0.25
```

It is {{ growth | % }} for your device. The nearer the drive to the resonance, the more.

## Would it show at 100 Hz?

Far below the resonance the spring alone decides: $x\approx F/k$, and the mass is nowhere in it.

```step
id = "slow"
kind = "question"
points = 1.0
question = "The same mass is added while the drive is at 100 Hz. What happens to the amplitude?"
[choice]
options = [
  { id = "nothing", text = "Next to nothing", share = 1.0, because = "the device is held by its springs there; 5 % of mass change it by a hundredth of a percent" },
  { id = "same", text = "The same as here", because = "the effect of the mass grows with the square of the frequency" },
  { id = "more", text = "More than here", because = "the effect of the mass grows with the square of the frequency" },
]
```

## Heal it

Press **Heal all** and wait until the bank says *healthy* again for 3 ms.

```step
id = "healed"
kind = "hold"
points = 1.0
for_ms = 3.0
conditions = [
  { label = "Added mass", fault = "added_mass", between = [0.0, 0.0] },
  { label = "The Kalman bank says", verdict = "kalman", equals = "healthy" },
]
```

## Conclusion

A fault shows in how the device moves, and how well it shows depends on where you drive it. A bank of models finds it within
a fraction of a millisecond, because each sample is compared with the prediction of each model.
','2026-11-26 13:09:56.760145');
CREATE TABLE votes (
	id VARCHAR(32) NOT NULL, 
	class_id VARCHAR(32), 
	question JSON NOT NULL, 
	state VARCHAR(16) NOT NULL, 
	hands JSON NOT NULL, 
	created DATETIME NOT NULL, 
	CONSTRAINT pk_votes PRIMARY KEY (id)
);
INSERT INTO "votes" VALUES('60248158355dcf8c','f7hk','{"text": "Which?", "answers": ["this", "that"], "diagnoser": "", "when": null, "right": ""}','open','[0, 0]','2026-11-26 13:09:57.065572');
CREATE INDEX ix_results_created ON results (created);
CREATE INDEX ix_recordings_created ON recordings (created);
CREATE INDEX ix_recordings_state ON recordings (state);
CREATE INDEX ix_recordings_bench_id ON recordings (bench_id);
CREATE INDEX ix_links_kind ON links (kind);
CREATE INDEX ix_links_created ON links (created);
CREATE INDEX ix_classes_created ON classes (created);
CREATE INDEX ix_people_class_id ON people (class_id);
CREATE INDEX ix_audit_at ON audit (at);
CREATE INDEX ix_audit_class_id ON audit (class_id);
CREATE INDEX ix_audit_bench_id ON audit (bench_id);
CREATE INDEX ix_blind_answers_class_id ON blind_answers (class_id);
CREATE INDEX ix_sheets_created ON sheets (created);
CREATE INDEX ix_sheet_progress_class_id ON sheet_progress (class_id);
CREATE INDEX ix_votes_class_id ON votes (class_id);
CREATE INDEX ix_lti_keys_class_id ON lti_keys (class_id);
CREATE INDEX ix_game_attempts_class_id ON game_attempts (class_id);
CREATE INDEX ix_game_attempts_person_id ON game_attempts (person_id);
CREATE INDEX ix_requests_kind ON requests (kind);
CREATE INDEX ix_requests_state ON requests (state);
CREATE INDEX ix_requests_created ON requests (created);
CREATE INDEX ix_records_created ON records (created);
CREATE INDEX ix_records_key ON records ("key");
CREATE INDEX ix_records_owner ON records (owner);
COMMIT;
