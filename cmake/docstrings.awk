# What Doxygen reads of a header: the comment at its top becomes the file's own text; functions that the compiler writes or
# forbids are left out, as they say nothing of their own; and what is declared together, `double low_mm, high_mm;`, is
# declared one by one, each with the docstring of all.

# The name of a declarator, with its value if it has one.
function is_declarator(text) {
    return text ~ /^[a-z][A-Za-z0-9_]*( = [A-Za-z0-9_:.-]+(\(\))?| = \{\}|\{\})?$/
}

# How long the type at the beginning of a declaration is, with the space behind it; 0: there is none.
function type_length(text) {
    return match(text, /^ +[A-Za-z_][A-Za-z0-9_:]*(<[^;]*>)? /) ? RLENGTH : 0
}

# Prints a line that declares several; 0: it does not.
function split_line(line,    end, behind, parts, count, k, type, names, length_of_type) {
    end = index(line, ";")
    length_of_type = type_length(line)
    if (!end || !length_of_type) return 0
    type = substr(line, 1, length_of_type)
    names = substr(line, length_of_type + 1, end - length_of_type - 1)
    behind = substr(line, end)
    count = split(names, parts, /, */)
    if (count < 2) return 0
    for (k = 1; k <= count; ++k) if (!is_declarator(parts[k])) return 0
    for (k = 1; k <= count; ++k) print (k > 1 ? docstring : "") type parts[k] behind
    return 1
}

/= (default|delete);$/ { print ""; docstring = ""; next }
NR == 1 { print "/// @file"; in_top = 1; next }
in_top && /^\/\// { sub(/^\/\//, "///"); print; next }
{ in_top = 0 }
/^ *\/\/\/ / { docstring = docstring $0 "\n"; print; next }
{ if (!split_line($0)) print; docstring = "" }
