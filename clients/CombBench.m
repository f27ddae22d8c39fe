% A MATLAB and GNU Octave client of a CombBench server: runs, campaigns and live benches, in one file to copy.
%
%     lab = CombBench('http://127.0.0.1:8000', getenv('COMBBENCH_TOKEN'));
%     wanted = struct('seed', 7, 'set', containers.Map({'sensor.noise_um'}, {0.06}));
%     done = lab.run('ch5-seven-step', wanted);
%     trace = lab.trace(done, {'plant.displacement', 'kalman.winner'});
%     plot(trace.time_ms, trace.plant_displacement)
%
% It needs the program curl, which Windows, macOS and most Linux systems have: Octave's own webwrite sends no JSON.
classdef CombBench < handle
    properties
        address
        token
    end

    methods
        function lab = CombBench(address, token)
            % A server by its address, and the token it printed when it started.
            lab.address = [regexprep(address, '/$', ''), '/api/v1'];
            lab.token = token;
        end

        function answer = ask(lab, method, path, body)
            % Ask for a path below /api/v1; the body is a struct or a map. JSON comes back as values.
            if nargin < 4
                body = [];
            end
            file = lab.fetch(method, path, body);
            tidy = onCleanup(@() delete_all({file}));
            answer = fileread(file);
            if ~isempty(answer) && any(answer(1) == '{[')
                answer = jsondecode(answer);
            end
        end

        function done = run(lab, scenario, fields)
            % Run a library id, TOML text or a struct headless, to its end; fields: seed, seeds, set.
            if nargin < 3
                fields = struct();
            end
            fields.scenario = scenario;
            done = lab.ended('/runs', lab.ask('POST', '/runs', fields));
        end

        function columns = trace(lab, run, signals)
            % Return signals of a run as columns, with tick and time_ms; the field names tells the signal of each.
            path = ['/runs/', run.id, '/trace?format=mat'];
            if nargin > 2
                asked = cellfun(@(name) ['&signals=', escaped(name)], signals, 'UniformOutput', false);
                path = [path, asked{:}];
            end
            file = lab.fetch('GET', path, []);
            tidy = onCleanup(@() delete_all({file}));
            columns = load(file, '-mat');
        end

        function done = sweep(lab, campaign)
            % Carry out a campaign, to its end.
            done = lab.ended('/sweeps', lab.ask('POST', '/sweeps', struct('sweep', campaign)));
        end

        function found = points(lab, sweep)
            % Return the points of a campaign with their figures.
            found = lab.ask('GET', ['/sweeps/', sweep.id, '/points']).points;
        end

        function made = bench(lab, scenario, fields)
            % Make a live bench; fields: paused, seed. Close it with lab.close(made).
            if nargin < 3
                fields = struct();
            end
            fields.scenario = scenario;
            made = lab.ask('POST', '/benches', fields);
        end

        function reply = command(lab, bench, fields)
            % Do something to a bench: struct('kind', 'step', 'ticks', 100), struct('switch', 'mrac').
            reply = lab.ask('POST', ['/benches/', bench.id, '/commands'], fields);
        end

        function close(lab, bench)
            % Close a live bench.
            lab.ask('DELETE', ['/benches/', bench.id]);
        end
    end

    methods (Access = private)
        function thing = ended(lab, kind, thing)
            while any(strcmp(thing.state, {'queued', 'running'}))
                pause(0.1);
                thing = lab.ask('GET', [kind, '/', thing.id]);
            end
            if ~strcmp(thing.state, 'done')
                error('CombBench:%s', thing.state, 'it is %s', thing.state);
            end
        end

        function file = fetch(lab, method, path, body)
            % Fetch into a file; the token goes to curl by a file too, so that no list of processes shows it.
            [settings, sent, file] = deal(tempname(), tempname(), tempname());
            tidy = onCleanup(@() delete_all({settings, sent}));
            lines = {['url = "', lab.address, path, '"'], ['request = "', method, '"'], ...
                ['header = "Authorization: Bearer ', lab.token, '"'], ['output = "', strrep(file, '\', '/'), '"'], ...
                'write-out = "%{http_code}"', 'silent', 'show-error'};
            if ~isempty(body)
                write_text(sent, jsonencode(body));
                lines = [lines, {'header = "Content-Type: application/json"', ...
                    ['data-binary = "@', strrep(sent, '\', '/'), '"']}];
            end
            write_text(settings, sprintf('%s\n', lines{:}));
            [failed, said] = system(['curl --config "', settings, '"']);
            if failed
                delete_all({file});
                error('CombBench:unreachable', '%s', strtrim(said));
            end
            if str2double(said) >= 400
                refused = jsondecode(fileread(file)).error;
                delete_all({file});
                error(['CombBench:', refused.code], '%s', refused.message);
            end
            if exist(file, 'file') ~= 2
                write_text(file, '');  % an answer without content
            end
        end
    end
end

function text = escaped(name)
    % Percent-encode a name for a query (RFC 3986): all bytes of UTF-8 but letters, digits and - . _ ~
    bytes = num2cell(unicode2native(name, 'UTF-8'));
    kept = ['A':'Z', 'a':'z', '0':'9', '-._~'];
    for k = 1:numel(bytes)
        if any(bytes{k} == kept)
            bytes{k} = char(bytes{k});
        else
            bytes{k} = sprintf('%%%02X', bytes{k});
        end
    end
    text = [bytes{:}];
end

function write_text(file, text)
    handle = fopen(file, 'w');
    fwrite(handle, unicode2native(text, 'UTF-8'));
    fclose(handle);
end

function delete_all(files)
    for k = 1:numel(files)
        if exist(files{k}, 'file') == 2
            delete(files{k});
        end
    end
end
