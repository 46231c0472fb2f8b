# Doxygen ends a number at its digit separator.
s/\([0-9]\)'\([0-9]\)/\1\2/g
# Aliases that every class of PCL has.
s/^ *using \(Ptr\|ConstPtr\|Base\|PointT\|SearchPtr\|Cloud\|PointCloudOut\) = [^;]*;$//
