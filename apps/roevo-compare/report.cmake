# Errors, ranks, tables and the report of a comparison.
add_library(roevo_report STATIC
            report/csv_table.cpp report/markdown_tables.cpp report/metrics.cpp report/protocol.cpp report/ranking.cpp
            report/results.cpp report/text.cpp report/write_comparison.cpp)
target_include_directories(roevo_report PUBLIC ${PROJECT_SOURCE_DIR}/apps)
target_link_libraries(roevo_report PUBLIC roevo_evaluation PRIVATE roevo_support roevo_build_flags)
