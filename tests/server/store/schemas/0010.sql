BEGIN TRANSACTION;
CREATE TABLE alembic_version (
	version_num VARCHAR(32) NOT NULL, 
	CONSTRAINT alembic_version_pkc PRIMARY KEY (version_num)
);
INSERT INTO "alembic_version" VALUES('0010');
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
CREATE TABLE classes (
	id VARCHAR(32) NOT NULL, 
	name VARCHAR(100) NOT NULL, 
	code_hash VARCHAR(64), 
	code_until DATETIME, 
	scenario JSON NOT NULL, 
	created DATETIME NOT NULL, 
	until DATETIME NOT NULL, secret VARCHAR(64) DEFAULT '' NOT NULL, 
	CONSTRAINT pk_classes PRIMARY KEY (id)
);
INSERT INTO "classes" VALUES('f7hk','Tuesday',NULL,NULL,'{"source": "ch5-seven-step", "values": {}, "seed": null, "paused": false, "time_scale": 0.002, "own_scale": true, "quiet_lead": false}','2026-11-26 13:09:55.600576','2099-01-01 00:00:00.000000','0pWHhGx8v9CE8yCYuwdttr2-EZqhavQBEuvgagDKn18');
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
	until DATETIME NOT NULL, 
	CONSTRAINT pk_people PRIMARY KEY (id), 
	CONSTRAINT uq_people_secret_hash UNIQUE (secret_hash)
);
INSERT INTO "people" VALUES('81299b607ecda7b1','student','Ada','f7hk','f4a1db1ea6f2','c929bcdde1a19f444a19070a403cf0bfd4298d4e75d0d2d53dafd36a9438159e','2026-11-26 13:09:55.634200','2099-01-01 00:00:00.000000');
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
CREATE INDEX ix_results_created ON results (created);
CREATE INDEX ix_recordings_bench_id ON recordings (bench_id);
CREATE INDEX ix_recordings_state ON recordings (state);
CREATE INDEX ix_recordings_created ON recordings (created);
CREATE INDEX ix_links_kind ON links (kind);
CREATE INDEX ix_links_created ON links (created);
CREATE INDEX ix_classes_created ON classes (created);
CREATE INDEX ix_people_class_id ON people (class_id);
CREATE INDEX ix_audit_at ON audit (at);
CREATE INDEX ix_audit_class_id ON audit (class_id);
CREATE INDEX ix_audit_bench_id ON audit (bench_id);
CREATE INDEX ix_requests_created ON requests (created);
CREATE INDEX ix_requests_kind ON requests (kind);
CREATE INDEX ix_requests_state ON requests (state);
COMMIT;
