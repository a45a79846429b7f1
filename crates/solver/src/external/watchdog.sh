# Reads what belongs to hyperplan until hyperplan is gone, however it went, and then ends and removes the rest.
# +GROUP a process group was started, -GROUP it has ended, anything else is the path of a temporary file.
trap '' HUP INT QUIT TERM
set -f
newline='
'
groups=' ' files=
while IFS= read -r line; do
  case $line in
    +*) groups="$groups${line#+} " ;;
    -*) groups="${groups%% ${line#-} *} ${groups#* ${line#-} }" ;;
    *) files="$files$line$newline" ;;
  esac
done
for group in $groups; do kill -9 "-$group"; done
IFS=$newline
[ -z "$files" ] || rm -f -- $files
