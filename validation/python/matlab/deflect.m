function [result, report] = deflect(command, varargin)
% DEFLECT  runs the program deflect and reads its JSON. For Octave 7 or later and MATLAB R2016b or later.
%
%   r = deflect("solve", "haptic-6psu", "--pose", [25 25 198.9], "--load", [50 0 0]);
%   r.msa.displacement          % 6x1: mm, rad
%   r.msa.stiffness             % 6x6: N/mm, N, Nmm
%   d = deflect("diagnose", "haptic-6psu-ideal-joints", "hidden.csv"); d.verdict
%   [r, report] = deflect("validate", "haptic-6psu", "--errata");
%
% Arguments are those of the program, see `deflect COMMAND --help`: names, files and options as text; numbers and
% arrays are written with all their digits, "--pose", [25 25 198.9] as --pose=25,25,198.9. Units are N, mm, deg for
% poses, rad for displacements. One process for each call.
%
%   result   the JSON of --json, by jsondecode: lists of numbers are columns, matrices are matrices. Octave 7 reads
%            numbers so to 15 digits. [] where the command has no --json (new, export, completion)
%   report   what the program prints for a person
%
% Errors have the identifiers deflect:InputError, deflect:MechanismError, deflect:NumericalError (exit codes 2, 3, 4)
% or deflect:Failed, and the program's message. The program is the one that the environment variable DEFLECT_PROGRAM
% names, else build/deflect of the checkout where this file lies, else deflect on the path.
  words = {char(command)};
  i = 1;
  while i <= numel(varargin)
    word = varargin{i};
    if is_option(word) && i < numel(varargin) && isnumeric(varargin{i + 1})
      words{end + 1} = [char(word) '=' numbers(varargin{i + 1})];
      i = i + 2;
    elseif isnumeric(word)
      words{end + 1} = numbers(word);
      i = i + 1;
    else
      words{end + 1} = char(word);
      i = i + 1;
    end
  end
  scratch = tempname();
  files = {[scratch '.json'], [scratch '.txt']};
  cleanup = onCleanup(@() remove(files));
  if has_json(words{1})
    words = [words, {'--json', files{1}}];
  end
  [status, report] = run(words, files{2});
  if status ~= 0
    message = strtrim(fileread(files{2}));
    kinds = {'InputError', 'MechanismError', 'NumericalError'};
    kind = 'Failed';
    if any(status == 2:4)
      kind = kinds{status - 1};
    end
    error(['deflect:' kind], '%s', message);
  end
  result = [];
  if exist(files{1}, 'file')
    result = jsondecode(fileread(files{1}));
  end
end

function yes = is_option(word)
  yes = ischar(word) || isa(word, 'string');
  yes = yes && strncmp(char(word), '--', 2);
end

function text = numbers(values)
  text = strjoin(arrayfun(@(x) sprintf('%.17g', x), values(:).', 'UniformOutput', false), ',');
end

function yes = has_json(command)
  persistent known
  if isempty(known)
    known = struct();
  end
  key = ['c_' strrep(command, '-', '_')];
  if ~isvarname(key)
    yes = false;
    return
  end
  if ~isfield(known, key)
    [status, help_text] = run({command, '--help'}, '/dev/null');
    known.(key) = status == 0 && ~isempty(strfind(help_text, '--json'));
  end
  yes = known.(key);
end

function [status, output] = run(words, errors)
  quoted = cellfun(@(w) ['''' strrep(w, '''', '''\''''') ''''], [{program()}, words], 'UniformOutput', false);
  [status, output] = system([strjoin(quoted, ' ') ' 2>''' errors '''']);
end

function path = program()
  path = getenv('DEFLECT_PROGRAM');
  if ~isempty(path)
    return
  end
  here = fileparts(mfilename('fullpath'));
  path = fullfile(here, '..', '..', '..', 'build', 'deflect');
  if ~exist(path, 'file')
    path = 'deflect';
  end
end

function remove(files)
  for i = 1:numel(files)
    if exist(files{i}, 'file')
      delete(files{i});
    end
  end
end
