# Errors, ranks, tables and the report of a comparison.
add_library(roevo_report STATIC
            report/baseline.cpp report/csv_table.cpp report/distribution_plots.cpp report/distributions.cpp
            report/error_plot.cpp report/html_many.cpp report/html_parts.cpp report/html_report.cpp report/html_sections.cpp
            report/html_sequence.cpp report/html_style.cpp report/line_style.cpp report/markdown_tables.cpp
            report/metrics.cpp report/plots.cpp report/protocol.cpp report/ranking.cpp report/remarks.cpp
            report/results.cpp report/scene_picture.cpp report/stage_plot.cpp report/tables.cpp report/trajectory_plot.cpp
            report/write_comparison.cpp)
target_include_directories(roevo_report PUBLIC ${PROJECT_SOURCE_DIR}/apps ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(roevo_report PUBLIC roevo_evaluation PRIVATE roevo roevo_programs roevo_build_flags)
