# Finds types that share a name and a namespace. Reads sources in the house style: a namespace's and a type's first
# line begin in the first column, and a namespace's last line says `// namespace`.
FNR == 1 { space = ""; nameless = 0 }
/^namespace \{/ { nameless = 1 }
/^namespace [a-z0-9_:]+ \{$/ { space = space "::" $2 }
/^}  \/\/ namespace [a-z0-9_:]+$/ { space = substr(space, 1, length(space) - length($4) - 2) }
/^}  \/\/ namespace$/ { nameless = 0 }
/^(struct|class|union|enum( class)?) [A-Za-z0-9_]+( final)?( : [^;]*)?( \{.*)?$/ {
  if (nameless) next
  name = space "::" ($2 == "class" ? $3 : $2)
  if (name in place && place[name] != FILENAME) {
    printf "%s:%d: %s is also the name of a type in %s: name one of them otherwise\n", FILENAME, FNR, substr(name, 3), place[name]
    found = 1
  }
  place[name] = FILENAME
}
END { exit found }
