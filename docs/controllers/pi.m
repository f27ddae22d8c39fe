% A PI controller for CombBench, in GNU Octave:
%
%     combbench run first-look --controller-process "octave-cli --quiet docs/controllers/pi.m"
%
% At each sample nine doubles come over standard input, and one double goes back over standard output.
kp = -2;  % V/um
ki = -9;  % V/(um ms)
integral = 0;
while true
    x = fread(stdin, 9, "double", 0, "ieee-le");
    if numel(x) < 9
        break  % the run has ended
    end
    begins = x(1); tick = x(2); time_ms = x(3); dt_ms = x(4);
    reference = x(5); model = x(6); measured = x(7); applied = x(8); engaged = x(9);
    e = model - measured;
    if begins
        integral = 0;
    end
    if engaged
        integral = integral + ki * e * dt_ms;
    else
        integral = applied - kp * e;  % in shadow: ready to take over from here
    end
    fwrite(stdout, kp * e + integral, "double", 0, "ieee-le");
    fflush(stdout);
end
