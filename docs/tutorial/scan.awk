# Writes the triangles of an OBJ file as STL, each with its own three corners, and turns every 97th over: what a scanner may hand out.
BEGIN { print "solid scan" }
/^v / { point[++n] = $2 " " $3 " " $4 }
/^f / {
    a = point[int($2)]; b = point[int($3)]; c = point[int($4)]
    if (++face % 97 == 0) { swap = b; b = c; c = swap }
    print "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet"
}
END { print "endsolid scan" }
